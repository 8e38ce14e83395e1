"""Forty people behind one address: the network of a lab is not counted, all others are."""

from __future__ import annotations

from ipaddress import ip_network

import pytest
import typer
from web.people import Server

from hearth.commands.serve import lab_of
from hearth.web.limits import usual_rates
from hearth.web.sender_addresses import is_of_lab


@pytest.mark.parametrize(("address", "most"), [("10.1.2.3", 40), ("10.2.0.1", 30)])
def test_a_lab_begins_as_many_sessions_as_it_has_people(tmp_path, knowledge, address, most):
    made = Server(tmp_path / "served", knowledge, rates=usual_rates(), lab=ip_network("10.1.0.0/16"))
    statuses = [made.client(client=(address, 50_000)).post("/begin").status_code for _ in range(40)]
    assert statuses[:most] == [303] * most
    assert (429 in statuses) == (most < 40)
    made.store.close()


def test_the_networks_of_a_lab():
    assert lab_of("") is None and not is_of_lab("10.1.2.3", None)
    assert is_of_lab("10.1.2.3", lab_of("10.1.2.3")) and not is_of_lab("10.1.2.4", lab_of("10.1.2.3"))
    assert is_of_lab("2001:db8:1:2::/64", lab_of("2001:db8:1::/48")) and not is_of_lab("10.1.2.3", lab_of("::/0"))
    with pytest.raises(typer.BadParameter, match="not an IP address or a network"):
        lab_of("the lab")
