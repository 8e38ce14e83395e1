"""Addresses of senders: every spelling of one is the same sender, and a network of IPv6 is one sender."""

from ipaddress import IPv4Address, IPv4Network, IPv6Network, ip_address, ip_network

from starlette.requests import HTTPConnection

from hearth.schemas.failures import Code
from hearth.web.web_errors import WebError

Network = IPv4Network | IPv6Network
"""A network of addresses."""

ONE_SENDER = 64
"""Bits of an IPv6 address that name a network: a sender with one address of it has all."""


def sender_of(asked: HTTPConnection) -> str:
    """Return the sender that limits count: an IPv4 address, or the network of an IPv6 one; "" where there is none.

    Raises:
        WebError: BAD_ARGUMENT: the address that a proxy names is not one.
    """
    return one_sender(asked.client.host) if asked.client and asked.client.host else ""


def is_of_lab(sender: str, lab: Network | None) -> bool:
    """Return whether a sender belongs to the network behind which many participants sit."""
    return lab is not None and bool(sender) and ip_network(sender).version == lab.version and _within(sender, lab)


def _within(sender: str, lab: Network) -> bool:
    found = ip_network(sender)
    return found.subnet_of(lab) or lab.subnet_of(found)  # type: ignore[arg-type]


def one_sender(address: str) -> str:
    """Return the sender of an address, in whichever way it is written.

    Raises:
        WebError: BAD_ARGUMENT: it is not an address.
    """
    try:
        found = ip_address(address.partition("%")[0])
    except ValueError:
        raise WebError(Code.BAD_ARGUMENT, "X-Forwarded-For", "an IP address", "something else") from None
    if isinstance(found, IPv4Address):
        return str(found)
    inside = found.ipv4_mapped
    if inside is not None or found.is_loopback:
        return str(inside or found)
    return str(IPv6Network((int(found), ONE_SENDER), strict=False))
