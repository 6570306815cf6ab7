"""All public functions, all of their parameters: no mistake passes unnamed, no rightful variant is refused."""

import pytest
from calls import CALLS, INSIDE, MADE_BY_THE_LIBRARY, everything
from runner import functions, outcomes, parameters_of, rightful, variants


def test_every_public_function_has_a_call():
    """A new function needs an entry of its own: only so are its arguments tried."""
    covered = {key.split(":")[0] for key in CALLS}
    lacking = sorted(functions().keys() - covered)
    assert not lacking, (
        f"tests/arguments/calls.py has no call of {', '.join(lacking)}: add to CALLS one that is right, quick, and "
        "gives a value for every parameter (or name it under INSIDE, with the reason, if nobody else is to call it)"
    )
    gone = sorted(covered - functions().keys())
    assert not gone, f"CALLS in tests/arguments/calls.py has {', '.join(gone)}, which the library no longer has"


@pytest.mark.parametrize("key", CALLS)
def test_a_call_gives_every_parameter(key):
    given, asked = set(rightful(key)), set(parameters_of(key))
    assert given == asked, f"CALLS[{key!r}] in tests/arguments/calls.py lacks {', '.join(sorted(asked - given))}"


@pytest.mark.parametrize("key", CALLS)
def test_mistakes_are_named(key):
    wrong = [
        f"{found.parameter} = {found.mistake}: {found.kind}, {found.message}"
        for found in outcomes(key)
        if found.kind != "clear"
    ]
    assert not wrong, f"{len(wrong)} mistakes in the arguments of {key} aren't named:\n  " + "\n  ".join(wrong)


@pytest.mark.parametrize("key", CALLS)
def test_rightful_variants_give_the_same(key):
    wrong = [
        f"{found.parameter} as {found.mistake}: {found.kind}, {found.message}"
        for found in variants(key)
        if found.kind != "same"
    ]
    assert not wrong, f"{key} takes numbers, arrays and texts of one form only:\n  " + "\n  ".join(wrong)


def test_what_is_left_out_is_public():
    """So that nothing stays on the lists that was renamed."""
    assert everything().keys() >= MADE_BY_THE_LIBRARY | INSIDE
