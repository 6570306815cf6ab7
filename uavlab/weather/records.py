"""Real hourly weather, without a download: a typical year of Greensboro, North Carolina, that pvlib carries.

The file `723170TYA.CSV` is of the collection TMY3 of the National Renewable Energy Laboratory (NREL): for each month
the most typical one of the years 1976 to 2005, measured at the airport (36.1° N, 79.95° W, 273 m above the sea).
pvlib ships it under the 3-clause BSD licence.
"""

from __future__ import annotations

from importlib.resources import files
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas

FEATURES = {
    "temp_air": "temperature_c",
    "relative_humidity": "humidity_percent",
    "pressure": "pressure_hpa",
    "wind_speed": "wind_speed",
    "wind_direction": "wind_from_deg",
    "ghi": "radiation",
}
"""pvlib's names, and ours."""


def greensboro_weather() -> pandas.DataFrame:
    """A typical year of Greensboro, hour by hour: the six features of REPARE's prediction (section 2.2.3).

    Its rain is left out: the column adds up to 8 345 mm, more than seven times what falls there in a year.

    Returns
    -------
    pandas.DataFrame
        8 760 rows, `hour` from 0 (the hour that ends at 01:00 local standard time on 1 January), with the columns
        temperature_c [°C], humidity_percent [%], pressure_hpa [hPa], wind_speed (at about 10 m above the ground)
        [m/s], wind_from_deg [degrees clockwise from north; 0 when it is calm] and radiation (global horizontal)
        [W/m²].

    Raises
    ------
    ImportError
        If pvlib is missing.

    See Also
    --------
    read_weather : your own record, from a CSV file.
    uavlab.prediction.synthetic_weather : made-up hours with the same columns.

    References
    ----------
    S. Wilcox and W. Marion, Users Manual for TMY3 Data Sets, NREL, 2008.

    Examples
    --------
    >>> from uavlab.weather import greensboro_weather
    >>> hours = greensboro_weather()
    >>> hours.shape
    (8760, 6)
    >>> f"{hours.temperature_c.mean():.1f} °C and {hours.wind_speed.mean():.1f} m/s on average"
    '14.4 °C and 3.1 m/s on average'
    """
    try:
        import pvlib
    except ImportError as missing:
        raise ImportError("greensboro_weather reads a file inside of pvlib: pip install pvlib") from missing
    records, _ = pvlib.iotools.read_tmy3(str(files("pvlib") / "data" / "723170TYA.CSV"), map_variables=True)
    features = records[list(FEATURES)].rename(columns=FEATURES).astype(float).reset_index(drop=True)
    return features.rename_axis("hour")
