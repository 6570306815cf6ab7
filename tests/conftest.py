"""What several tests share."""

import pytest
from hypothesis import settings

from uavlab.city import City, table1_city

settings.register_profile("any machine", deadline=None)  # tests don't time
settings.load_profile("any machine")


@pytest.fixture(scope="session")
def table1() -> City:
    """The city of REPARE Table 1, rasterised once."""
    return table1_city()
