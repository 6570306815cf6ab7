"""What the tests of the exercises share."""

import pytest
from solved import solutions_of


@pytest.fixture
def solutions(request):
    """The names that the solutions of a chapter define, by the name of its test module."""
    return solutions_of(request.module.__name__.removeprefix("test_chapter"))


@pytest.fixture
def blank():
    """A function as the exercise notebooks hand it out."""

    def blank(*_):
        raise NotImplementedError

    return blank
