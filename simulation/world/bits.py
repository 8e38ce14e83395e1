"""Sets of nodes as integers: bit i stands for the node of index i."""

from collections.abc import Iterable, Iterator


def indices(mask: int) -> Iterator[int]:
    """Yield the members of a set, ascending."""
    while mask:
        lowest = mask & -mask
        yield lowest.bit_length() - 1
        mask ^= lowest


def lowest(mask: int) -> int:
    """Return the smallest member, or -1 of the empty set."""
    return (mask & -mask).bit_length() - 1


def cleared(mask: int, members: int) -> int:
    """Return the set without some members."""
    return mask & ~members


def mask_of(members: Iterable[int]) -> int:
    """Return the set with these members."""
    mask = 0
    for index in members:
        mask |= 1 << index
    return mask
