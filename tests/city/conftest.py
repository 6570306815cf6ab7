"""Writers of the files that the readers read."""

import pytest
from files import write


@pytest.fixture
def geojson(tmp_path):
    def collection(*features, **members):
        document = {"type": "FeatureCollection", "features": features, **members}
        return write(tmp_path / "town.geojson", document)

    return collection


@pytest.fixture
def cityjson(tmp_path):
    def model(vertices, objects, **members):
        document = {"type": "CityJSON", "version": "2.0", "CityObjects": objects, "vertices": vertices, **members}
        return write(tmp_path / "model.city.json", document)

    return model
