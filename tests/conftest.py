"""What several tests share."""

import pytest

from uavlab.city import City, table1_city


@pytest.fixture(scope="session")
def table1() -> City:
    """The city of REPARE Table 1, rasterised once."""
    return table1_city()
