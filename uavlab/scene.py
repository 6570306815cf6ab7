"""Scenes in three dimensions: the city, its routes and the UAV that flies them, in meshcat's viewer.

A scene is one self-contained page: meshcat's viewer script and the scene's commands, packed. No server runs and no
port is opened, so scenes work offline, in a notebook that was exported to HTML, and give the same bytes each
time. Each kind of thing is one merged mesh. In a notebook `show` displays the page, and beside it a still picture
for places that can't run scripts.
"""

from __future__ import annotations

import base64
import gzip
import html
import io
from collections.abc import Mapping, Sequence
from functools import lru_cache
from importlib.resources import files
from itertools import pairwise
from typing import Any

import meshcat
import meshcat.geometry as g
import numpy as np
import numpy.typing as npt
import umsgpack
from matplotlib.colors import to_rgb
from meshcat.animation import Animation
from meshcat.transformations import translation_matrix

from uavlab import checks, plot
from uavlab.city import City
from uavlab.flight import Flight
from uavlab.risk import RiskMap
from uavlab.route import Route

FRAMES_PER_SECOND = 30
FLIGHT_SECONDS = 12.0
LAST_FRAME = round(1.2 * FLIGHT_SECONDS * FRAMES_PER_SECOND)
"""Then the animation begins again."""
EXPANSION_BATCHES = 40
MOST_POINTS = 12_000
"""Larger expansions are thinned out evenly, so that their page stays small."""
FIELD_OF_VIEW_DEG = 40.0
FAR_OFF = 1000.0
"""Scenes lie about the multiple of this that is next to their map's centre [m]: viewers count in float32."""


class Scene:
    """A page with a scene in it; the last line of a notebook's cell shows it."""

    def __init__(self, page: str, height: int, still: bytes) -> None:
        self.page = page
        self.height = height
        self.still = still

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        frame = (
            f'<div class="uavlab-scene"><iframe srcdoc="{html.escape(self.page)}" title="3D scene" '
            f'style="width:100%;height:{self.height}px;border:0"></iframe></div>'
        )
        return {"text/html": frame, "image/png": base64.b64encode(self.still).decode(), "text/plain": "<3D scene>"}


def show(
    city: City,
    *routes: plot.Drawn,
    safe_distance: float | None = None,
    expansion: bool = False,
    risk: RiskMap | None = None,
    slice_height: float | None = None,
    flights: Sequence[Flight] | Mapping[str, Flight] = (),
    height: int = 480,
) -> Scene:
    """The scene for a notebook; arguments as for `page`, and the frame's height in pixels."""
    picture = io.BytesIO()
    plot.still(city, *routes, risk=risk, flights=flights).savefig(picture, format="png", dpi=72)
    content = page(
        city,
        *routes,
        safe_distance=safe_distance,
        expansion=expansion,
        risk=risk,
        slice_height=slice_height,
        flights=flights,
    )
    return Scene(content, height, picture.getvalue())


def page(
    city: City,
    *routes: plot.Drawn,
    safe_distance: float | None = None,
    expansion: bool = False,
    risk: RiskMap | None = None,
    slice_height: float | None = None,
    flights: Sequence[Flight] | Mapping[str, Flight] = (),
    title: str | None = None,
) -> str:
    """One self-contained HTML page with the city, its routes, and a UAV that flies the first of them.

    With `flights` the UAVs fly those instead, all by the same clock.

    Parameters
    ----------
    city : City
        Drawn from its buildings, roofs included; from its voxels where it knows no buildings. Its ground is a surface
        with a grid on it, no-fly zones are prisms that one can look through.
    routes : Route or Curve, or mapping
        By name if it is a mapping. Drawn as tubes, each in a colour of its own; routes that didn't arrive are named in
        the legend.
    safe_distance : float, optional
        Radius of a ball around each UAV [m]: the clearance it should keep.
    expansion : bool
        Show in which order the first route's planner expanded its nodes (`record=True`), as an animation.
    risk : RiskMap, optional
        Paints the ground with the risk in the lowest voxels where the UAV may fly; the legend has a colour bar.
    slice_height : float, optional
        Draws the risk at this height [m] too, as a plane that one can look through.
    flights : sequence of Flight, or mapping
        What `uavlab.flight.fly` returns, by name if it is a mapping. Each track is a tube in a colour of its own; a
        crash is a red X that appears when and where it happens. Routes are drawn thinner then.
    title : str, optional
        Of the page; by default the city's name.

    Returns
    -------
    str
        HTML, about 300 kB; needs no network.

    Raises
    ------
    ValueError
        If `expansion` is asked for without a route that recorded its order or together with flights, `safe_distance`
        is not above 0, `slice_height` lies outside of the map, or there is no `risk` to slice.
    """
    planned = plot.drawn_routes(city, routes, risk)
    if slice_height is not None and risk is None:
        raise ValueError("slice_height needs risk=..., the map to cut")
    if safe_distance is not None:
        checks.positive_number("safe_distance", safe_distance)
        safe_distance = float(safe_distance)  # the viewer's commands take no NumPy scalars
    if expansion and not (planned and "order" in planned[0].info):
        raise ValueError("expansion needs a first route planned with record=True")
    named = plot.named_flights(flights)
    if expansion and named:
        raise ValueError("expansion and flights are two animations: show them in two scenes")
    window = CommandRecorder()
    scene = meshcat.Visualizer(window=window)
    set_stage(scene, city, painted=risk is not None)
    draw_city(scene["city"], city)
    if city.no_fly:
        draw_zones(scene["no_fly"], city)
    if risk is not None:
        draw_risk(scene["risk"], risk, slice_height)
    animation = Animation(default_framerate=FRAMES_PER_SECOND)
    colors = plot.route_colors(len(planned) + len(named))
    for number, (route, color) in enumerate(zip(planned, colors, strict=False)):
        if len(route.points) > 1:
            draw_route(scene[f"route{number}"], city, route, color, thin=bool(named))
    flown = {name: flight for name, flight in named.items() if len(flight.log) > 1}
    longest = max((flight.duration for flight in flown.values()), default=0.0)
    for number, (name, color) in enumerate(zip(named, colors[len(planned) :], strict=True)):
        if name in flown:
            animate_flight(scene[f"flight{number}"], city, flown[name], color, longest, safe_distance, animation)
    if expansion:
        animate_expansion(scene["expansion"], city, planned[0].info["order"], animation)
    elif not named and planned and len(planned[0].points) > 1:
        animate_route(scene["uav"], city, planned[0], safe_distance, animation)
    if animation.clips:
        scene.set_animation(animation, repetitions=1000)
    return window.page(title or city.name, legend(city, planned, named, risk))


def legend(city: City, routes: tuple[Route, ...], flights: Mapping[str, Flight], risk: RiskMap | None = None) -> str:
    """What the colours mean and how large things are, as HTML."""
    colors = plot.route_colors(len(routes) + len(flights))
    about = [f"<b>{html.escape(city.name)}</b>", f"squares of {grid_spacing(city):g} m", "x → east, y → north, z → up"]
    lines = [" · ".join(filter(None, [*about, plot.ground_words(city)]))]
    texts = [
        f"{route.planner}: {route.length:.1f} m" if route.reached else f"{route.planner}: {route.reason}"
        for route in routes
    ]
    texts += [plot.label_of_flight(name, flight) for name, flight in flights.items()]
    for text, color in zip(texts, colors, strict=True):
        lines.append(f'<span style="color:{color}">&#9608;&#9608;</span> {html.escape(text)}')
    zones = plot.zones_at(city)
    if zones:
        lines.append(
            f'<span style="color:{plot.ZONE_COLOR}">&#9618;&#9618;</span> {html.escape(plot.zone_label(zones))}'
        )
    marks = []
    if any(len(route.points) > 1 for route in routes) or any(len(flight.log) > 1 for flight in flights.values()):
        marks += ["&#9679; start", "&#9650; goal"]
    if any(flight.outcome == "crashed" for flight in flights.values()):
        marks.append(f'<b style="color:{plot.CRASH_COLOR}">&#10006;</b> crash')
    if flights:
        longest = max(flight.duration for flight in flights.values())
        marks.append(f"{FLIGHT_SECONDS:g} s show {longest:.1f} s of flight")
    if marks:
        lines.append(" &nbsp; ".join(marks))
    if risk is not None:
        norm = plot.risk_norm(risk)
        stops = ",".join(plot.sequential_color(share) for share in np.linspace(0, 1, 9))
        style = f"display:inline-block;width:9em;height:.8em;background:linear-gradient(90deg,{stops})"
        bar = f'<span style="{style}"></span>'
        lines.append(f"{norm.vmin:.1e} {bar} {norm.vmax:.1e} deaths per hour of flight (scale of factors)")
    return "<br>".join(lines)


def nearby(city: City, points: np.ndarray) -> np.ndarray:
    """Points (..., 3) [m] of a map that may lie far off, such as in UTM, from a multiple of a kilometre near it."""
    return points - FAR_OFF * np.round(city.bounds.mean(axis=0) / FAR_OFF)


def set_stage(scene: meshcat.Visualizer, city: City, *, painted: bool = False) -> None:
    """Ground, if it isn't painted, light and a camera that sees the whole map."""
    low, high = city.bounds
    size = high - low
    center = (low + high) / 2
    top = max((building.bounds[1, 2] for building in city.buildings), default=high[2])
    floor = low[2] if city.ground is None else city.ground.min()
    center[2] = floor + 0.34 * (max(top, floor) - floor)
    reach = float(np.hypot(size[0], size[1]))
    scene["/Background"].set_property("top_color", [0.86, 0.92, 1.0])
    scene["/Background"].set_property("bottom_color", [1.0, 1.0, 1.0])
    scene["/Axes"].set_property("visible", False)
    scene["/Grid"].set_property("visible", False)
    scene["/Lights/FillLight/<object>"].set_property("position", [-4.0, -7.0, 9.0])
    scene["/Lights/FillLight/<object>"].set_property("intensity", 0.45)
    scene.set_transform(translation_matrix(-nearby(city, center)))  # the camera circles the origin
    camera = scene["/Cameras/default/rotated/<object>"]
    camera.set_property("fov", FIELD_OF_VIEW_DEG)
    camera.set_property("near", reach / 100)
    camera.set_property("far", 20 * reach)
    camera.set_property("position", [0.48 * reach, 0.86 * reach, 1.18 * reach])  # east, up, south
    if city.ground is None:
        corners = np.array([(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])])
        ground = nearby(city, np.column_stack([corners, np.full(4, low[2] - 0.002 * reach)]))
        scene["ground"].set_object(mesh(ground[[[0, 1, 2], [0, 2, 3]]]), g.MeshBasicMaterial(color=0xE9E9E4))
    elif not painted:
        lattice = nearby(city, plot.ground_lattice(city))
        vertices = np.round(256 * lattice.reshape(-1, 3)) / 256  # short numbers make small pages
        land = g.TriangularMeshGeometry(vertices.astype(np.float32), plot.lattice_triangles(lattice.shape[:2]))
        scene["ground"].set_object(land, g.MeshLambertMaterial(color=as_number(plot.LAND_COLOR), side=2))
    draw_lines(scene["grid"], nearby(city, grid_lines(city, 0.002 * reach)), 0xB8B8B0)


def grid_lines(city: City, lift: float) -> np.ndarray:
    """Ends (2L, 3) [m] of a grid's lines: on the bottom of the map, or `lift` above its ground, which they follow."""
    (low, high), spacing = city.bounds, grid_spacing(city)
    lines = []
    for axis, other in ((0, 1), (1, 0)):
        count = 2 if city.ground is None else min(city.shape[other], plot.MOST_QUADS) + 1
        for value in np.arange(np.ceil(low[axis] / spacing) * spacing, high[axis] + 1e-9, spacing):
            points = np.full((count, 3), low[2])
            points[:, axis] = value
            points[:, other] = np.linspace(low[other], high[other], count)
            if city.ground is not None:
                points[:, 2] = plot.ground_below(city, points) + lift
            lines.append(np.repeat(points, 2, axis=0)[1:-1])
    return np.concatenate(lines)


def grid_spacing(city: City) -> float:
    """A round number of metres that divides the map into about ten squares."""
    extent = float((city.bounds[1] - city.bounds[0])[:2].max())
    magnitude = 10.0 ** np.floor(np.log10(extent / 10))
    return float(magnitude * min((1, 2, 5, 10), key=lambda m: abs(extent / (magnitude * m) - 10)))


def draw_city(scene: meshcat.Visualizer, city: City) -> None:
    """All buildings as one mesh with their colours, and their edges as lines."""
    if not city.buildings:
        surface = nearby(city, plot.voxel_surface(city))
        if len(surface):
            scene["voxels"].set_object(mesh(surface), g.MeshLambertMaterial(color=0xB0C4DE))
        return
    surfaces = [building.triangles() for building in city.buildings]
    colors = [
        np.tile(to_rgb(building.color), (3 * len(triangles), 1))
        for building, triangles in zip(city.buildings, surfaces, strict=True)
    ]
    scene["buildings"].set_object(
        mesh(nearby(city, np.concatenate(surfaces)), np.concatenate(colors)), g.MeshLambertMaterial(vertexColors=True)
    )
    edges = np.concatenate([building.edges() for building in city.buildings])
    draw_lines(scene["edges"], nearby(city, edges), 0x555555)


def draw_zones(scene: meshcat.Visualizer, city: City) -> None:
    """All no-fly zones as one mesh that one can look through, and their edges as lines."""
    surface, edges = plot.zone_surface(city)
    if len(surface):
        color = as_number(plot.ZONE_COLOR)
        glass = g.MeshLambertMaterial(color=color, transparent=True, opacity=0.28, side=2, depthWrite=False)
        scene["walls"].set_object(mesh(nearby(city, surface)), glass)
        draw_lines(scene["edges"], nearby(city, edges), color)


def draw_risk(scene: meshcat.Visualizer, risk_map: RiskMap, slice_height: float | None) -> None:
    """The ground painted with the risk above it, and a slice at a height, both on one scale of factors."""
    city = risk_map.city
    norm = plot.risk_norm(risk_map)

    def paint(name: str, values: np.ndarray, shown: np.ndarray, height: npt.ArrayLike, opacity: float) -> None:
        triangles = plot.layer_triangles(city, height)[shown.ravel()].reshape(-1, 3, 3)
        colors = np.repeat(plot.SEQUENTIAL(norm(values[shown]))[:, :3], 6, axis=0)
        material = g.MeshBasicMaterial(vertexColors=True, transparent=opacity < 1, opacity=opacity, side=2)
        scene[name].set_object(mesh(nearby(city, triangles), colors), material)

    everywhere = np.ones(city.shape[:2], dtype=bool)
    below = city.origin[2] if city.ground is None else plot.ground_lattice(city, max(city.shape))[..., 2]
    paint("ground", plot.ground_risk(risk_map), everywhere, below + 0.01 * city.cell, 1.0)
    if slice_height is not None:
        k = plot.level_of(city, slice_height)
        paint("slice", risk_map.rate[:, :, k], risk_map.flyable[:, :, k], slice_height, 0.6)


def draw_route(scene: meshcat.Visualizer, city: City, route: Route, color: str, *, thin: bool = False) -> None:
    """A route as a tube, a ball at its start and a cone at its goal."""
    draw_way(scene, city, route.points, color, thickness=0.4 if thin else 1.0)
    draw_goal(scene["goal"], city, route.points[-1], color)


def draw_way(scene: meshcat.Visualizer, city: City, points: np.ndarray, color: str, *, thickness: float = 1.0) -> None:
    """A tube along points, and a ball at the first of them."""
    radius, material = tube_radius(city), g.MeshLambertMaterial(color=as_number(color))
    surface = tube(nearby(city, points), thickness * radius)
    if len(surface):  # a UAV that stays where it is leaves none
        scene["tube"].set_object(mesh(surface), material)
    scene["start"].set_object(g.Sphere(2.5 * radius), material)
    scene["start"].set_transform(translation_matrix(nearby(city, points[0])))


def draw_goal(scene: meshcat.Visualizer, city: City, goal: np.ndarray, color: str) -> None:
    """A cone around the goal."""
    radius = tube_radius(city)
    cone = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 6 * radius]])
    shape = mesh(tube(cone, 3 * radius, end_radius=0.0))
    scene.set_object(shape, g.MeshLambertMaterial(color=as_number(color)))
    scene.set_transform(translation_matrix(nearby(city, goal) - [0.0, 0.0, 3 * radius]))


def tube_radius(city: City) -> float:
    """Of a route's tube [m], by the size of the map."""
    return 0.004 * float(np.linalg.norm(city.bounds[1] - city.bounds[0]))


def as_number(color: str) -> int:
    """#rrggbb as meshcat has it."""
    return int(color.lstrip("#"), 16)


def draw_uav(scene: meshcat.Visualizer, city: City, safe_distance: float | None) -> None:
    """A quadrotor, larger than life, with the ball around it that should stay clear."""
    scale = 0.02 * float(np.linalg.norm(city.bounds[1] - city.bounds[0]))
    scene["body"].set_object(mesh(quadrotor(scale)), g.MeshLambertMaterial(color=0x222222, side=2))
    if safe_distance is not None:
        scene["clearance"].set_object(
            g.Sphere(safe_distance), g.MeshLambertMaterial(color=0xFFFFFF, transparent=True, opacity=0.35)
        )


def animate_route(
    scene: meshcat.Visualizer, city: City, route: Route, safe_distance: float | None, animation: Animation
) -> None:
    """A UAV that flies a route at constant speed, again and again."""
    draw_uav(scene, city, safe_distance)
    share = route.distance / max(route.length, 1e-9)
    move(scene, nearby(city, route.points), share * FLIGHT_SECONDS, animation)


def animate_flight(
    scene: meshcat.Visualizer,
    city: City,
    flight: Flight,
    color: str,
    longest: float,
    safe_distance: float | None,
    animation: Animation,
) -> None:
    """The track of a flight and a UAV on it, by a clock that shows `longest` seconds; a crash is a red X."""
    time, points = plot.track(flight)
    places = nearby(city, np.vstack([points, points[-1]]))
    clock = time / longest * FLIGHT_SECONDS
    draw_way(scene, city, points, color)
    draw_uav(scene["uav"], city, safe_distance)
    move(scene["uav"], places, np.append(clock, LAST_FRAME / FRAMES_PER_SECOND), animation)
    if flight.outcome == "arrived":
        draw_goal(scene["goal"], city, points[-1], color)
    if flight.outcome == "crashed":
        arms = plot.cross(places[-1], 7 * tube_radius(city))
        beams = np.concatenate([tube(arm, 1.6 * tube_radius(city)) for arm in arms])
        through_walls = {"depthTest": False}  # a crash behind a building is to be seen, too
        red = g.MeshBasicMaterial(color=as_number(plot.CRASH_COLOR), transparent=True, **through_walls)
        scene["crash"].set_object(mesh(beams), red)
        appear(scene, "crash", clock[-1] * FRAMES_PER_SECOND, animation)


def move(scene: meshcat.Visualizer, points: np.ndarray, clock: np.ndarray, animation: Animation) -> None:
    """Be at each of the points (N, 3) when the animation's clock (N,) [s] says so."""
    scene.set_transform(translation_matrix(points[0]))
    for point, moment in zip(points, clock, strict=True):
        with animation.at_frame(scene, round(moment * FRAMES_PER_SECOND)) as frame:
            frame.set_transform(translation_matrix(point))


def appear(scene: meshcat.Visualizer, name: str, moment: float, animation: Animation) -> None:
    """Be unseen until a frame, and there until the animation begins again."""
    for frame_number, visible in ((0, False), (max(round(moment), 1), True), (LAST_FRAME, True)):
        with animation.at_frame(scene, frame_number) as frame:
            frame[name].set_property("visible", "boolean", visible)


def animate_expansion(scene: meshcat.Visualizer, city: City, order: np.ndarray, animation: Animation) -> None:
    """Expanded nodes as points that appear in the order of their expansion, first ones dark, last ones bright."""
    shown = order[:: -(-len(order) // MOST_POINTS)]
    batches = np.array_split(shown, min(EXPANSION_BATCHES, len(shown)))
    for number, nodes in enumerate(batches):
        points = nearby(city, city.center_of(city.index_of(nodes))).T.astype(np.float32)
        color = np.array(to_rgb(plot.sequential_color(number / max(len(batches) - 1, 1))), dtype=np.float32)
        name = f"batch{number}"
        scene[name].set_object(g.PointCloud(points, np.tile(color, (len(nodes), 1)).T, size=0.9 * city.cell))
        appear(scene, name, 1 + number * FLIGHT_SECONDS * FRAMES_PER_SECOND / len(batches), animation)


def mesh(triangles: np.ndarray, colors: np.ndarray | None = None) -> g.TriangularMeshGeometry:
    """Triangles (T, 3, 3) as a geometry; no corner is shared, so that the light shows each face flat."""
    vertices = np.asarray(triangles, dtype=np.float32).reshape(-1, 3)
    return g.TriangularMeshGeometry(vertices, np.arange(len(vertices)).reshape(-1, 3), color=colors)


def draw_lines(scene: meshcat.Visualizer, ends: np.ndarray, color: int) -> None:
    """Straight lines between each two of the points (2L, 3)."""
    geometry = g.PointsGeometry(np.asarray(ends, dtype=np.float32).T)
    scene.set_object(g.LineSegments(geometry, g.LineBasicMaterial(color=color)))


def tube(points: np.ndarray, radius: float, *, end_radius: float | None = None, sides: int = 8) -> np.ndarray:
    """Triangles (T, 3, 3) of a round tube along a polyline (N, 3); with `end_radius` each leg is a cone."""
    angle = np.linspace(0.0, 2 * np.pi, sides + 1)[:, None]
    triangles = []
    for start, end in pairwise(np.asarray(points, dtype=float)):
        along = end - start
        length = np.linalg.norm(along)
        if length == 0:
            continue
        along = along / length
        across = np.cross(along, [0.0, 0.0, 1.0] if abs(along[2]) < 0.9 else [1.0, 0.0, 0.0])
        across /= np.linalg.norm(across)
        ring = np.cos(angle) * across + np.sin(angle) * np.cross(along, across)
        low, high = start + radius * ring, end + (radius if end_radius is None else end_radius) * ring
        triangles.append(np.stack([low[:-1], low[1:], high[1:]], axis=1))
        triangles.append(np.stack([low[:-1], high[1:], high[:-1]], axis=1))
        triangles.append(np.stack([low[1:], low[:-1], np.broadcast_to(start, (sides, 3))], axis=1))
        triangles.append(np.stack([high[:-1], high[1:], np.broadcast_to(end, (sides, 3))], axis=1))
    return np.concatenate(triangles) if triangles else np.empty((0, 3, 3))


def quadrotor(size: float) -> np.ndarray:
    """Triangles of a small quadrotor, `size` metres from rotor axis to centre: two arms and four discs."""
    tips = size * np.array([(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0)]) / np.sqrt(2)
    parts = [tube(tips[[0, 2]], 0.08 * size), tube(tips[[1, 3]], 0.08 * size)]
    axle = np.array([[0.0, 0.0, 0.1 * size], [0.0, 0.0, 0.14 * size]])
    parts += [tube(tip + axle, 0.55 * size, sides=16) for tip in tips]
    parts.append(tube(np.array([[0.0, 0.0, -0.15 * size], [0.0, 0.0, 0.15 * size]]), 0.3 * size))
    return np.concatenate(parts)


class CommandRecorder:
    """Stands where meshcat expects its window to the server: keeps the commands, and packs them into a page."""

    def __init__(self) -> None:
        self.commands: dict[tuple[str, str], bytes] = {}
        self.names: dict[str, str] = {}

    def send(self, command: Any) -> None:
        """Keep a command; a later one for the same thing replaces it."""
        lowered = command.lower()
        kind = lowered["type"] + lowered.get("property", "")
        self.commands[lowered["path"], kind] = umsgpack.packb(self.stable(lowered))

    def stable(self, value: Any) -> Any:
        """The same value with random identifiers replaced by a count, so that the same scene gives the same bytes."""
        if isinstance(value, dict):
            return {key: self.stable(item) for key, item in value.items()}
        if isinstance(value, list):
            return [self.stable(item) for item in value]
        if isinstance(value, str) and len(value) == 36 and value.count("-") == 4:
            return self.names.setdefault(value, f"id{len(self.names)}")
        return value

    def page(self, title: str, caption: str) -> str:
        """The whole page; the animation comes last, when all that it moves is there."""
        ordered = sorted(self.commands.items(), key=lambda item: item[0][1] == "set_animation")
        packed = b"".join(len(command).to_bytes(4, "big") + command for _, command in ordered)
        return PAGE.format(title=html.escape(title), legend=caption, viewer=viewer_script(), commands=compress(packed))


@lru_cache(1)
def viewer_script() -> str:
    return compress(files("meshcat").joinpath("viewer/dist/main.min.js").read_bytes())


def compress(content: bytes) -> str:
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode()


PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>
body{{margin:0;font:13px/1.5 system-ui,sans-serif}}
#pane{{width:100vw;height:100vh;overflow:hidden}}
#legend{{position:absolute;left:8px;bottom:8px;padding:4px 10px;background:rgba(255,255,255,.85);border-radius:4px}}
.dg.main{{display:none}}
</style></head><body><div id="pane"></div><div id="legend">{legend}</div><script>
const unpack = async text => {{
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}};
(async () => {{
  const script = document.createElement("script");
  script.textContent = new TextDecoder().decode(await unpack("{viewer}"));
  document.head.appendChild(script);
  const commands = new Uint8Array(await unpack("{commands}")), view = new DataView(commands.buffer);
  const viewer = window.viewer = new MeshCat.Viewer(document.getElementById("pane"));
  for (let at = 0; at < commands.length;) {{
    const length = view.getUint32(at);
    viewer.handle_command_bytearray(commands.slice(at + 4, at + 4 + length));
    at += 4 + length;
  }}
  viewer.set_3d_pane_size();
  document.body.dataset.ready = "yes";
}})().catch(error => {{
  document.getElementById("legend").append(" — this browser can't draw the scene: " + error.message);
}});
</script></body></html>
"""
