"""What several tests share."""

import pytest
from chromium import FLAGS, chromium_path
from hypothesis import settings
from playwright.sync_api import sync_playwright

from uavlab.city import City, table1_city

settings.register_profile("any machine", deadline=None)  # tests don't time
settings.load_profile("any machine")


@pytest.fixture(scope="session")
def table1() -> City:
    """The city of REPARE Table 1, rasterised once."""
    return table1_city()


@pytest.fixture(scope="module")
def browser():
    """A real Chromium."""
    if chromium_path() is None:
        pytest.skip("no Chromium on this machine: apt-get install chromium, then run the browser tests again")
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=chromium_path(), args=FLAGS)
        yield chromium
        chromium.close()
