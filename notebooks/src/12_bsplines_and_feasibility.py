# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 12 B-splines and feasibility
#
# A planner returns a list of voxels. No UAV flies that: at every voxel's centre it would have to stop and turn.
# RISK-ACO ([doi:10.19650/j.cnki.cjsi.J2007192](https://doi.org/10.19650/j.cnki.cjsi.J2007192)) and PSO-BAS
# ([doi:10.23919/JSEE.2022.000111](https://doi.org/10.23919/JSEE.2022.000111)) lay a cubic B-spline over the list, see
# that its curvature is below 1 and its pitch below a limit, and call it flyable. So the question of this notebook is:
# **what does a UAV fly when a planner gives it a list of points, and is a smooth curve a flyable one?** We build the
# curve by hand and mend what is printed; find that it cuts corners, and through walls, and repair that; and then put a
# speed beside the curvature, which neither paper does. ("Eq. 3" is an equation of this notebook, "PSO-BAS Eq. 25" one
# of the paper's.)
#
# *Run All* (in the menu **Run**) brings the 3D scene and the slider to life.

# %%
from dataclasses import replace

import numpy as np
from IPython.display import display
from scipy.interpolate import BSpline
from scipy.stats import binomtest

from uavlab import plot, scene, spline
from uavlab.city import table1_city
from uavlab.planners import astar, least_risk, refine, shortcut, waypoint_swarm
from uavlab.risk import CAMPUS_FLIGHT, random_campus, reference_campus
from uavlab.spline import Curve, allowed_speed, cubic_bspline, feasibility, greatest_speed, smooth
from uavlab.vehicle import GRAVITY, RISK_QUADROTOR

# %% tags=["nbval-check-output"]
BLACK, BLUE, GREEN, ORANGE, PINK, YELLOW = plot.BLACK, plot.BLUE, plot.GREEN, plot.ORANGE, plot.PINK, plot.YELLOW
COLORS = {"least risk + B-spline": BLACK, "swarm, 1 waypoint": ORANGE, "PSO-BAS, its B-spline": GREEN}
uav = RISK_QUADROTOR
print(f"{uav.name}: {uav.diameter:g} m wide, cruises at {uav.cruise_speed:g} m/s, {uav.thrust:g} N of thrust")

# %% [markdown]
# ## Four points, one piece of curve
#
# A cubic B-spline is made of pieces, *segments*. Each is a mean of four points, with weights that change along the way
# (RISK-ACO Eq. 19, PSO-BAS Eq. 25):
#
# $$ \mathbf S_i(t) = \frac16 \begin{pmatrix} t^3 & t^2 & t & 1 \end{pmatrix}
#    \begin{pmatrix} -1 & 3 & -3 & 1 \\ 3 & -6 & 3 & 0 \\ -3 & 0 & 3 & 0 \\ 1 & 4 & 1 & 0 \end{pmatrix}
#    \begin{pmatrix} \mathbf P_i \\ \mathbf P_{i+1} \\ \mathbf P_{i+2} \\ \mathbf P_{i+3} \end{pmatrix},
#    \qquad 0 \le t \le 1. \tag{1} $$


# %%
MATRIX = np.array([[-1, 3, -3, 1], [3, -6, 3, 0], [-3, 0, 3, 0], [1, 4, 1, 0]]) / 6


def segment(four, t):
    """Eq. 1: points (T, 2) at t (T,) from four control points (4, 2)."""
    return np.column_stack([t**3, t**2, t, np.ones_like(t)]) @ MATRIX @ four


t = np.linspace(0, 1, 51)
control = np.array([[0, 0], [4, 7], [11, 8], [13, 1], [20, 0], [26, 5], [25, 12.0]])
weights = segment(np.eye(4), t)
assert np.allclose(weights.sum(axis=1), 1, atol=1e-15)
assert (weights > -1e-15).all()

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 2, width=11, height=4.2)
shares = {f"P{number}": weights[:, number] for number in range(4)}
plot.lines(t, shares, "parameter t", "weight of the point", axes=panels[0])
plot.diagram("x [m]", "y [m]", paths={"control polygon": control[:4], "segment": segment(control[:4], t)},
             notes={f"P{n}": point for n, point in enumerate(control[:4])}, x_range=(-1, 14.5), y_range=(-1, 9),
             colors={"control polygon": "0.5"}, axes=panels[1])  # fmt: skip
figure

# %% [markdown]
# The weights are at least 0 and their sum is 1: each segment stays within the hull of its four points. The next one
# takes $\mathbf P_1 \dots \mathbf P_4$, and so on. Three things on the papers' pages would not work.
#
# **The points of a segment.** Both print $\mathbf P_0 \dots \mathbf P_3$ in the formula for *every* $\mathbf S_i$:
# that draws the first segment again and again. It must be $\mathbf P_i \dots \mathbf P_{i+3}$.
#
# **The ends.** With $t = 0$ in Eq. 1
#
# $$ \mathbf S_i(0) = \tfrac16 \left(\mathbf P_i + 4\,\mathbf P_{i+1} + \mathbf P_{i+2}\right), \tag{2} $$
#
# so the curve begins near the *second* point, and a UAV that follows it neither takes off at its start nor arrives. A
# *phantom* point $2\mathbf P_0 - \mathbf P_1$ before the first makes Eq. 2 give $\mathbf P_0$. Or each end stands three
# times (*clamped*), which does as well, but starts from rest.

# %%
phantom = np.vstack([2 * control[0] - control[1], control, 2 * control[-1] - control[-2]])
by_hand = np.vstack([segment(phantom[i : i + 4], t[:-1]) for i in range(len(phantom) - 3)] + [control[-1:]])
assert np.abs(cubic_bspline(control, per_segment=50) - by_hand).max() < 1e-12

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 2, share="y", width=11, height=4.6)
polygon, colors = {"control polygon": control}, {"control polygon": "0.5", "phantom points": BLACK}
first = {"as printed: P₀ … P₃": segment(control[:4], t), "Pᵢ … Pᵢ₊₃": cubic_bspline(control, 50, ends="none")}
ends = {"phantom ends": by_hand, "clamped ends": cubic_bspline(control, 50, ends="clamped")}
plot.diagram("x [m]", "y [m]", paths=polygon | first, colors=colors, axes=panels[0])
plot.diagram("x [m]", "y [m]", paths=polygon | ends, points={"phantom points": phantom[[0, -1]]}, colors=colors,
             axes=panels[1])  # fmt: skip
figure

# %% [markdown]
# **The basis.** The papers also write the curve as a sum of basis functions (RISK-ACO Eq. 18, PSO-BAS Eqs 22 to 24):
#
# $$ \mathbf Q(t) = \sum_i B_{i,n}(t)\, \mathbf P_i, \qquad
#    B_{i,n}(t) = \frac{t - t_i}{t_{i+n} - t_i}\, B_{i,n-1}(t) +
#    \frac{t_{i+n+1} - t}{t_{i+n+1} - t_{i+1}}\, B_{i+1,n-1}(t), \tag{3} $$
#
# where $B_{i,0}$ is 1 between two knots and 0 elsewhere. They call $B_{i,n}$ "of order $n$, degree $n - 1$"; each round
# of Eq. 3 multiplies by $t$ once, so its degree is $n$ and its order $n + 1$. And they close the intervals on *both*
# sides, $t_i \le t \le t_{i+1}$ (PSO-BAS Eq. 23). At a knot two of them then count, and the basis adds up to 2.

# %% tags=["nbval-check-output"]
knots = np.arange(11.0)
t = np.linspace(0, 10, 401)  # the knots are among them
ours, printed = spline.basis_functions(t, knots), spline.basis_functions(t, knots, as_printed=True)
at_knots, inner = np.isclose(t % 1, 0) & (t >= 3) & (t <= 7), (t >= 3) & (t <= 7)
sums = {"ours": ours[inner], "printed, at knots": printed[at_knots], "printed, elsewhere": printed[inner & ~at_knots]}
for name, values in sums.items():
    print(f"sum of the basis from t = 3 to 7, {name:<18}", *np.unique(values.sum(axis=1).round(12)))
within = ours[(t > 4) & (t < 5)]
degree = next(n for n in range(6) if np.abs(np.diff(within, n + 1, axis=0)).max() < 1e-12)
print(f"within a segment B_i,3 has the degree {degree}")
for name, basis in (("ours", ours), ("as printed", printed)):
    print(f"the curve at t = 4, {name:<10}", (basis[t == 4][0] @ control).round(3))
assert degree == 3
assert np.allclose(printed[at_knots].sum(axis=1), 2)
assert np.allclose(ours[inner].sum(axis=1), 1, atol=1e-14)

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 2, share="y", width=11, height=4.0)
one = {"B₃,₃: four intervals wide": ours[:, 3]}
plot.lines(t, one | {"sum of all": ours.sum(axis=1)}, "parameter t", "basis functions", y_range=(-0.1, 3.0),
           title="half-open intervals (ours)", axes=panels[0])  # fmt: skip
smoothly = np.where(np.isclose(t % 1, 0), np.nan, printed.sum(axis=1))
at_knots = {"B₃,₃ at the knots": np.column_stack([knots, printed[::40, 3]]),
            "sum at the knots": np.column_stack([knots, printed[::40].sum(axis=1)])}  # fmt: skip
plot.lines(t, one | {"sum between the knots": smoothly}, "parameter t", "basis functions", points=at_knots,
           title="closed intervals (as printed)", axes=panels[1])  # fmt: skip
figure

# %% [markdown]
# Who evaluates the printed basis at the knots gets a UAV that jumps to twice its coordinates once per segment. Is ours
# right? SciPy has B-splines as well. Three ways to the same curve: Eq. 1, Eq. 3, and SciPy's.

# %% tags=["nbval-check-output"]
rng = np.random.default_rng(11)
off = {"matrix, phantom ends": [], "matrix, clamped ends": [], "basis, degrees 1 to 5": []}
for count in range(2, 42):
    points = rng.uniform(-100, 100, (count, 3))
    first, last = points[:1], points[-1:]
    phantoms = np.vstack([2 * first - points[1:2], points, 2 * last - points[-2:-1]])
    for ends, padded in (("phantom", phantoms), ("clamped", np.vstack([first, first, points, last, last]))):
        theirs = BSpline(np.arange(len(padded) + 4) - 3.0, padded, 3)(np.arange(8 * (len(padded) - 3) + 1) / 8)
        off[f"matrix, {ends} ends"].append(np.abs(cubic_bspline(points, ends=ends) - theirs).max())
    for degree in range(1, 6):
        knots = np.sort(rng.uniform(0, 1, degree + 12))
        t = np.linspace(knots[degree], knots[-degree - 1], 50)
        theirs = BSpline.design_matrix(t, knots, degree).toarray()
        off["basis, degrees 1 to 5"].append(np.abs(spline.basis_functions(t, knots, degree) - theirs).max())
for name, apart in off.items():
    print(f"{name:<22} {len(apart)} times {'like' if max(apart) < 1e-12 else 'NOT like'} SciPy's to 1e-12")
assert max(map(max, off.values())) < 1e-12

# %% [markdown]
# ## What "smooth" means
#
# At a knot, where $\mathbf P_1$ is the middle of three points, Eq. 1 gives from both sides
#
# $$ \mathbf r' = \tfrac12 (\mathbf P_2 - \mathbf P_0), \qquad
#    \mathbf r'' = \mathbf P_0 - 2\mathbf P_1 + \mathbf P_2, \tag{4} $$
#
# and within a segment $\mathbf r''' = \mathbf P_3 - 3\mathbf P_2 + 3\mathbf P_1 - \mathbf P_0$, one constant for each.
# Position, first and second derivative have no jump (the curve is $C^2$), the third has: the force on the UAV changes
# steadily, the rate at which it changes doesn't.

# %%
t = np.linspace(0, 6, 301)
panels_of = [cubic_bspline(control, 50, derivative=n) for n in range(3)]
names = ("r [m]", "r′ [m per segment]", "r″ [m per segment²]", "r‴ [m per segment³]")
values_of = [*panels_of, np.repeat(np.diff(phantom, 3, axis=0), 2, axis=0)]
figure, panels = plot.new_panels(1, 4, width=12, height=3.6)
for axes, name, values in zip(panels, names, values_of, strict=True):
    at = t if len(values) == 301 else np.repeat(np.arange(7), 2)[1:-1] + np.tile([0, -1e-6], 6)
    plot.lines(at, {"x": values[:, 0], "y": values[:, 1]}, "parameter [segments]", name, axes=axes)
jumps = [np.abs(np.diff(values, axis=0)).max() for values in panels_of]
assert max(jumps) < 0.5 < 5 < np.abs(np.diff(phantom, 4, axis=0)).max()  # steps of 1/50 of a segment, and a jump
figure

# %% [markdown]
# **Local control.** A point has a weight in four segments only. Move it, and the rest of the curve stays as it was,
# to the last digit: a route can be mended in one place.

# %% tags=["nbval-check-output"]
way = np.column_stack([np.arange(0, 55, 5.0), [0, 3, -2, 4, 0, 2, -3, 3, 0, -2, 1]])
moved = way.copy()
moved[5] += (0.0, 7.0)
before, after = cubic_bspline(way, 40), cubic_bspline(moved, 40)
changed = np.array([(before[40 * i : 40 * i + 41] != after[40 * i : 40 * i + 41]).any() for i in range(10)])
print(f"moving control point 5 of 0 to 10 changes segments {np.flatnonzero(changed)} of 0 to 9")
assert np.flatnonzero(changed).tolist() == [3, 4, 5, 6]
paths = {"control points": way, "before": before, "after: segments 3 to 6": after[120:281]}
plot.diagram("x [m]", "y [m]", paths=paths, points={"point 5, moved by 7 m": moved[5:6]},
             colors={"control points": "0.6", "before": BLUE, "after: segments 3 to 6": ORANGE,
                     "point 5, moved by 7 m": ORANGE})  # fmt: skip

# %% [markdown]
# ## It cuts corners
#
# A B-spline doesn't pass through its points. By Eq. 2 it passes the middle one of three at a distance of a sixth of
# $|\mathbf P_0 - 2\mathbf P_1 + \mathbf P_2|$; for two legs of length $L$ that turn by $\theta$ this is
#
# $$ \text{cut} = \frac{L}{3} \sin\frac\theta2. \tag{5} $$
#
# On the grid legs are a voxel long, and the cut is a fraction of that. Any-angle routes
# ([05 A*](05_astar.ipynb)) often have legs of ten to fifty metres, and pass the corners of buildings closely, because
# they are short. Here is one through REPARE's city, 30 m above the ground, planned to keep 1 m. The body is 0.4 m wide.

# %% tags=["nbval-check-output"]
city = table1_city()
grid_route = astar(city, (90.5, 18.5, 30.5), (50.5, 44.5, 30.5), min_clearance=1.0)
route = shortcut(grid_route, city)
raw, repaired = Curve(route.points, planner="not repaired"), smooth(route, city, uav, min_clearance=0.0)
kept = smooth(route, city, uav)  # the metre that the route promised
for name, curve in (("not repaired", raw), ("repaired", repaired), ("keeping 1 m", kept)):
    sharpest = curve.curvature.max()
    print(f"{name:<13} {len(curve.control):2d} points, clear {curve.clearance(city):.2f} m, κ ≤ {sharpest:.3f} 1/m,",
          f"so at most {allowed_speed(sharpest):.1f} m/s")  # fmt: skip
assert raw.clearance(city) == 0.0
assert repaired.clearance(city) > uav.diameter / 2
assert allowed_speed(kept.curvature.max()) < allowed_speed(raw.curvature.max()) / 2

# %%
both = {"repaired": repaired, "keeping 1 m": kept}
plot.corner(city, raw, both, center=(62, 22, 30.5), reach=13, uav_diameter=uav.diameter, route=route)

# %% [markdown]
# `smooth` measures the whole curve: the exact distance to the voxels at points an eighth of the body apart, less what
# the curve may do in between. Where the body touches, it puts midpoints into the legs around: shorter legs, smaller
# cuts (Eq. 5). After six rounds it repeats points, twice and thrice, which pulls the curve down to the straight lines;
# those are clear, since `smooth` refuses a route that isn't. A route remembers the distance that it was planned with,
# and `smooth` keeps that unless it is asked for less; `min_clearance=0.0` leaves room for the body only.
#
# How often is it needed? 170 pairs, planned to keep 1 m, so that each route itself is clear.

# %%
pairs = city.random_pairs(170, 11, apart=40, min_clearance=1.5)
on_grid = [astar(city, *pair, min_clearance=1.0) for pair in pairs]
any_angle = [shortcut(found, city) for found in on_grid]
bent = np.array([len(found.points) > 2 for found in any_angle])
clear = {
    "every node of the grid": np.array([Curve(found.points).clearance(city) for found in on_grid]),
    "any-angle, not repaired": np.array([Curve(found.points).clearance(city) for found in any_angle]),
}
mended = {number: smooth(any_angle[number], city, uav, min_clearance=0.0) for number in np.flatnonzero(bent)}
clear["any-angle, repaired"] = clear["any-angle, not repaired"].copy()  # straight routes have nothing to repair
clear["any-angle, repaired"][bent] = [curve.clearance(city) for curve in mended.values()]

# %% tags=["nbval-check-output"]
radius = uav.diameter / 2
print(f"bodies that touch            {len(bent)} routes   the {bent.sum()} of them that bend   least clearance")
for name, values in clear.items():
    touches = values < 0.98 * radius  # smooth counts as contact what overlaps by 2 % of the radius
    shares = [binomtest(int(hit.sum()), len(hit)) for hit in (touches, touches[bent])]
    texts = ("{:5.1%} [{:5.1%}, {:5.1%}]".format(s.statistic, *s.proportion_ci(method="wilson")) for s in shares)
    print(f"{name:<24}", *texts, f"{values.min():24.2f} m")
rounds = np.bincount([curve.info["rounds"] for curve in mended.values()])
print("rounds of repair:", ", ".join(f"{n} for {count} routes" for n, count in enumerate(rounds)))
print("routes with repeated points:", sum(curve.info["repeated"] > 0 for curve in mended.values()))
assert (clear["every node of the grid"] >= radius).all()
assert (clear["any-angle, repaired"] >= 0.98 * radius).all()
assert bent.sum() > 100
assert 0.35 < np.mean(clear["any-angle, not repaired"][bent] < radius) < 0.65

# %% [markdown]
# Nodes of the grid: none. Any-angle routes that bend: every second one would be flown into a wall. After repair: none.
# The price is curvature:

# %% tags=["nbval-check-output"]
touched = np.flatnonzero(clear["any-angle, not repaired"] < radius)
curves = {
    "grid": [Curve(on_grid[number].points) for number in touched],
    "any-angle": [Curve(any_angle[number].points) for number in touched],
    "repaired": [mended[number] for number in touched],
}
speeds = {name: allowed_speed([c.level_curvature.max() for c in group]) for name, group in curves.items()}
print(f"greatest speed with 30° of bank on the {len(touched)} routes that needed repair [m/s]")
for name, values in speeds.items():
    print("{:<10} median {:4.1f}, quartiles {:4.1f} and {:4.1f}".format(name, *np.quantile(values, [0.5, 0.25, 0.75])))
assert np.median(speeds["grid"]) < np.median(speeds["repaired"]) < np.median(speeds["any-angle"])

# %%
scene.show(city, repaired, {"any-angle route": route})

# %% [markdown]
# ## The papers' figures: curvature and pitch along the way
#
# How sharply a curve bends is its curvature, one over the radius of the circle that fits best:
#
# $$ \kappa = \frac{|\mathbf r' \times \mathbf r''|}{|\mathbf r'|^3}. \tag{6} $$
#
# The exponent is 3, and not 2/3 or 2 as some programs have it: `curvature` on a circle and on a helix, run through at
# uneven speed, must give what geometry says.

# %% tags=["nbval-check-output"]
time = np.linspace(0.1, 3, 7)
angle, rate, gain = time**2, 2 * time, 2.0  # an angle that grows faster and faster
for radius_, climb, name in ((4.0, 0.0, "circle of 4 m"), (4.0, 3.0, "helix of 4 m that climbs 3 m per radian")):
    along = np.column_stack([-radius_ * np.sin(angle), radius_ * np.cos(angle), np.full(7, climb)])
    inward = np.column_stack([-radius_ * np.cos(angle), -radius_ * np.sin(angle), np.zeros(7)])
    kappa = spline.curvature(along * rate[:, None], along * gain + inward * rate[:, None] ** 2)
    print(f"{name}: κ = {kappa.min():.6f} to {kappa.max():.6f} 1/m, wanted {radius_ / (radius_**2 + climb**2):.6f}")
    assert np.allclose(kappa, radius_ / (radius_**2 + climb**2), rtol=1e-12)

# %% [markdown]
# RISK-ACO's Figs 9 and 10 (PSO-BAS Figs 7 and 8) draw curvature and pitch along one smoothed route. Ours is the route
# of least risk on the reference campus ([08 Risk maps](08_risk_maps.ipynb)), with voxels of 5 m, and beside it a curve
# by PSO-BAS's swarm ([11](11_particle_swarm_and_beetles.ipynb)). Both keep 3 m from walls.

# %%
campus, (start, goal) = reference_campus(), CAMPUS_FLIGHT
exact = least_risk(campus, start, goal, min_clearance=3.0)
swarm = waypoint_swarm(campus, start, goal, rng=4, min_clearance=3.0)
smoothed = smooth(exact, campus.city, uav)
of_swarm = Curve(swarm.info["control"], planner="PSO-BAS, its B-spline")
for curve in (smoothed, of_swarm):
    sharpest, steepest = curve.curvature.max(), np.degrees(np.abs(curve.pitch).max())
    per_voxel = campus.city.cell * sharpest
    print(f"{curve.planner:<22} κ ≤ {sharpest:.3f} 1/m = {per_voxel:.2f} per voxel, pitch ≤ {steepest:.1f}°")
assert campus.city.cell * smoothed.curvature.max() < 1 < campus.city.cell * of_swarm.curvature.max()
plot.curve_profile(smoothed, of_swarm, speed=uav.cruise_speed, cell=campus.city.cell, colors=COLORS)

# %% [markdown]
# So the claim can be met: on the exact route κ stays below 1 per voxel and the pitch is at most 45°, without a jump.
# (The swarm's curve misses the first limit.) The lower grey line is ours, and every bend is above it.
#
# ## Why "below 1" doesn't make it flyable
#
# A level turn takes the acceleration $v^2 \kappa$ sideways. A multirotor that banks by $\varphi$ has $g\tan\varphi$:
#
# $$ v^2 \kappa \le g \tan\varphi. \tag{7} $$
#
# With $\varphi = 30°$ that is 5.66 m/s². At 16 m/s (PSO-BAS Table 2) κ must be below 0.022 1/m, a circle of 45 m. "1
# per voxel of 5 m" is a circle of 5 m: it takes 51 m/s², five times the UAV's weight. A curvature alone says nothing,
# and one *per voxel* even less: on voxels of 1 m the same turns keep the papers' limit and are five times as sharp.
#
# Can a route on a grid do it? At the knot of a turn by $\theta$ between even legs Eq. 4 has $|\mathbf r'| =
# L\cos\frac\theta2$, $|\mathbf r''| = 2L\sin\frac\theta2$, at right angles, so
#
# $$ \kappa L = \frac{2\sin(\theta/2)}{\cos^2(\theta/2)}. \tag{8} $$


# %% tags=["nbval-check-output"]
def turn_of(degrees, leg=1.0, legs=4):
    """A curve that turns once, between even legs."""
    theta = np.radians(degrees)
    ahead = np.array([[1, 0, 0]] * legs + [[np.cos(theta), np.sin(theta), 0]] * legs)
    return Curve(leg * np.vstack([np.zeros(3), np.cumsum(ahead, axis=0)]), step=leg / 500)


limit = GRAVITY * np.tan(np.radians(30)) / uav.cruise_speed**2
print(f"at 16 m/s κ ≤ {limit:.4f} 1/m, a radius of {1 / limit:.1f} m")
print("turn   κL: Eq. 8, measured   cut/L: Eq. 5, measured   16 m/s needs legs of, and cuts")
for degrees in (45, 60, 90):
    half, curve = np.radians(degrees) / 2, turn_of(degrees)
    eq8, eq5 = 2 * np.sin(half) / np.cos(half) ** 2, np.sin(half) / 3
    cut = np.linalg.norm(curve.points - curve.control[4], axis=1).min()
    row = eq8, curve.curvature.max(), eq5, cut, eq8 / limit, eq5 * eq8 / limit
    print(f"{degrees:3d}° " + "{:12.3f} {:9.3f} {:15.3f} {:9.3f} {:20.0f} m {:9.1f} m".format(*row))
    assert np.allclose([eq8, eq5], [curve.curvature.max(), cut], rtol=1e-4)

# %% [markdown]
# So already a turn of 60° breaks the papers' own limit, with 1.33 per voxel. RISK-ACO allows such turns; it is the grid
# that makes them 45°, with 0.897. And multiplying Eqs 5 and 8,
#
# $$ \text{cut} = \frac{1}{\kappa}\,\frac23 \tan^2\frac\theta2 \ge
#    \frac{v^2}{g \tan\varphi}\,\frac23 \tan^2\frac\theta2: \tag{9} $$
#
# **whoever is fast must cut corners.** At 16 m/s a turn of 45° is 5 m off its corner, one of 90° 30 m. No repair can
# have both: it makes the cut small, therefore the curvature large. What do the exact routes of forty random campuses
# need, smoothed over every node?

# %% tags=["nbval-check-output"]
found = [Curve(least_risk(random_campus(seed), start, goal).points) for seed in range(40)]
level = np.array([curve.level_curvature.max() for curve in found])
per_voxel = np.array([5.0 * curve.curvature.max() for curve in found])
needed = {"sideways, level": 256 * level, "whole": 256 * per_voxel / 5}
for name, values in needed.items():
    low, median, high = np.quantile(values, [0, 0.5, 1])
    print(f"acceleration at 16 m/s, {name:<16} median {median:.1f} m/s², from {low:.1f} to {high:.1f}")
enough = GRAVITY * np.tan(np.radians(30))
print(f"a bank of 30° gives {enough:.2f} m/s²")
meets = {
    by: sum(feasibility(curve, campus.city, uav, as_printed=True, reading=by).feasible for curve in found)
    for by in ("plan", "space")
}
print(f"the papers' limit is met by {meets['plan']} of {len(found)} in plan, by {meets['space']} in space")
speeds = np.array([greatest_speed(curve, uav) for curve in found])
print("greatest speed: median {:.1f} m/s, from {:.1f} to {:.1f}".format(*np.quantile(speeds, [0.5, 0, 1])))
assert meets == {"plan": 40, "space": 38}
assert needed["sideways, level"].min() > 6 * 5.66
assert speeds.max() < 6.5

# %% [markdown]
# The papers don't say which curvature they mean, that of the plan or that of the track in space. In plan all 40 are
# "flyable" by their rule, in space 38. And not one of them is at 16 m/s: the sideways acceleration is six times too
# large at the least. They can be flown at 5 to 6 m/s.
#
# ## The report
#
# `feasibility` asks for all that could fail, at a speed: the distance to obstacles, the borders of the map, the height
# above ground, curvature and pitch, how fast it climbs and sinks, and the thrust and tilt that hold weight, drag and
# turn together. It says where each is worst. The papers' check, and ours:

# %%
fastest, report = greatest_speed(smoothed, uav), feasibility(smoothed, campus.city, uav)
print("as printed\n", feasibility(smoothed, campus.city, uav, as_printed=True), "\n", sep="")
print("ours\n", report, "\n", sep="")
print("slower\n", feasibility(smoothed, campus.city, uav, speed=fastest), sep="")
assert feasibility(smoothed, campus.city, uav, as_printed=True).feasible
assert not report.feasible
assert report["thrust"].worst > 2.5 * uav.thrust
assert report["tilt"].worst > 90
assert 5.4 < fastest < 5.6
assert feasibility(smoothed, campus.city, uav, speed=fastest).feasible

# %% [markdown]
# The thrust fails as well: in the sharpest bends it would take more than twice what the rotors have, and where the
# curve bends downwards the UAV would have to fly upside down (a tilt above 90°). It would also climb and sink faster
# than it can. At 5.5 m/s all is well.
#
# ## What helps
#
# *Slower.* Always possible. But the risk is per hour, and who is slow is longer above people. *Finer.* `refine` finds a
# curve of less risk ([11](11_particle_swarm_and_beetles.ipynb)). *Fewer control points.* By Eq. 8 long legs bend less:
# the swarm with one to five waypoints, eight seeds each, 3 m or more from walls. For each the greatest speed, and the
# deaths per flight at that speed (a slower wreck hits less hard: the risk map is computed again for each speed).


# %%
def deaths_at(curve, speed):
    """Deaths per 10⁹ flights along a curve at a constant speed."""
    at_speed = replace(campus, uav=replace(uav, cruise_speed=speed))
    return 1e9 * at_speed.fatalities(curve, speed)


candidates = {"exact route, every node": [smoothed]}
finer = [refine(exact, campus, rng=seed, min_clearance=3.0) for seed in range(3)]
candidates["exact, refined"] = [Curve(found.info["control"]) for found in finer]
for count in (5, 4, 3, 2, 1):
    planned = [
        waypoint_swarm(campus, start, goal, rng=seed, waypoints=count, refinement=0.0, min_clearance=3.0)
        for seed in range(8)
    ]
    name = f"swarm, {count} waypoints"[: -1 if count == 1 else None]
    candidates[name] = [Curve(found.info["control"], planner=name) for found in planned if found.reached]

# %%
table = {}
print("                         speed [m/s]      risk [1e-6/h]   deaths per 1e9 flights   flyable at 16 m/s")
for name, group in candidates.items():
    rows = [(v := greatest_speed(c, uav), 1e6 * campus.integral(c), deaths_at(c, v)) for c in group]
    table[name] = np.array(rows)
    able = [feasibility(curve, campus.city, uav).feasible for curve in group]
    middle = np.median(table[name], axis=0)
    print(f"{name:<24} {middle[0]:11.1f} {middle[1]:18.2f} {middle[2]:18.2f} {sum(able):19d} of {len(able)}")
blind = Curve(least_risk(campus, start, goal, risk_weight=0.0, length_weight=1.0, min_clearance=3.0).points)
print(f"shortest, every node     {greatest_speed(blind, uav):11.1f} {1e6 * campus.integral(blind):18.2f} "
      f"{deaths_at(blind, greatest_speed(blind, uav)):18.2f}")  # fmt: skip
print(f"exact route at 16 m/s, if it could: {deaths_at(smoothed, 16.0):.2f} deaths per 1e9 flights")
assert np.median(table["exact, refined"], axis=0)[0] < greatest_speed(smoothed, uav)
assert np.median(table["swarm, 1 waypoint"], axis=0)[2] < deaths_at(smoothed, fastest)

# %% tags=["figure"]
plot.points({name: table[name][:, [0, 2]] for name in candidates}, "greatest speed within all limits [m/s]",
            "deaths per 10⁹ flights at that speed", places={"cruise\nspeed": uav.cruise_speed}, x_range=(0, 20),
            y_range=(0, 1.2 * max(values[:, 2].max() for values in table.values())))  # fmt: skip

# %% [markdown]
# Refining makes a curve *less* flyable: it moves points for the risk alone. Slower isn't safer: the route of least
# risk, at the speed at which it can be flown, costs more lives per flight than a curve with one free waypoint, which
# has over a third more risk per hour but takes less than half the time. And no curve of them all can be flown at cruise
# speed. The fastest, with a single waypoint, bends gently enough. But at 16 m/s it would climb with 8 m/s, and the UAV
# can do 6. Its report at 16 m/s, and both curves in 3D:

# %%
quickest = max(candidates["swarm, 1 waypoint"], key=lambda curve: greatest_speed(curve, uav))
its_speed = greatest_speed(quickest, uav)
more = campus.integral(quickest) / campus.integral(smoothed)
quicker = (quickest.length / its_speed) / (smoothed.length / fastest)
print(f"at {its_speed:.1f} m/s: risk per hour {more:.2f} times that of the exact route, time {quicker:.2f}, deaths per "
      f"flight {deaths_at(quickest, its_speed) / deaths_at(smoothed, fastest):.2f} times")  # fmt: skip
assert 11.5 < its_speed < 12
assert 1.3 < more < 1.5
assert quicker < 0.5
display(feasibility(quickest, campus.city, uav))
plot.curve_profile(smoothed, quickest, speed=uav.cruise_speed, cell=campus.city.cell, colors=COLORS)

# %%
scene.show(campus.city, quickest, {"least risk + B-spline": smoothed}, risk=campus, uav=campus.uav, colors=COLORS)

# %% [markdown]
# Neither planner knew the limit. One that searches among flyable curves only, by Eq. 7 in the place of "κ < 1", would
# find some; and a UAV may slow down just where it has to (exercise 12.3).
#
# Turn the speed and the curve yourself, with 30° of bank. Below which speed is the exact route flyable, and what fails first?


# %%
shown = {"exact route": smoothed, "swarm, 1 waypoint": quickest, "swarm, 7 waypoints": of_swarm}


def turn(curve="exact route", speed=5.0, bank_deg=30.0):
    """A curve's curvature and pitch, and which limits it breaks."""
    bank = np.radians(bank_deg)
    limits = feasibility(shown[curve], campus.city, uav, speed=speed, bank=bank).limits
    figure = plot.curve_profile(shown[curve], speed=speed, cell=campus.city.cell, bank=bank, colors=COLORS)
    beyond = ", ".join(limit.name for limit in limits if not limit.met) or "no limit"
    figure.axes[0].set_title(f"beyond: {beyond}", fontsize=10)
    return figure


# %%
values, first = {"curve": list(shown), "speed": [2, 4, 5, 6, 8]}, {"speed": 5}
plot.sliders(turn, title="curvature and pitch", labels={"speed": "speed [m/s]"}, start=first, progress=False, **values)

# %% [markdown]
# ## What the papers say, what we find
#
# | RISK-ACO, PSO-BAS | say | we find |
# |---|---|---|
# | Eq. 19, Eq. 25 | $\mathbf P_0 \dots \mathbf P_3$ in every segment | draws one; $\mathbf P_i \dots \mathbf P_{i+3}$ |
# | | (ends not mentioned) | misses both; phantom or clamped ends |
# | Eq. 18, Eq. 22 | order $n$, degree $n - 1$ | the recursion has degree $n$ |
# | PSO-BAS Eq. 23 | intervals closed on both sides | sum 2 at each knot: twice the coordinates |
# | text | continuous curvature ($C^2$) | yes; the third derivative jumps |
# | text | a point changes only its surroundings | yes: four segments |
# | (not said) | whether the curve hits a wall | all nodes of a grid: 0 of 170 |
# | | | any-angle that bend: 55 % [45, 64]; repaired: 0 of 106 |
# | Fig. 9, Fig. 7 | κ below 1 per coding unit | in plan 40 of 40 campuses, in space 38: yes |
# | | | 60° make 1.33, 90° make 2.83: **partly** |
# | Fig. 10, Fig. 8 | pitch below π/3, π/4 | at most 45°: yes, but not *below* π/4 |
# | conclusions | can be flown | at 16 m/s: 37 m/s² sideways, 30° give 5.66: **no** |
# | | (speed not mentioned) | at 5.5 m/s; or at 11.7 m/s with one free waypoint, for 38 % more risk per hour |
#
# (Intervals are 95 %, Wilson.) How far gusts push a UAV off such a curve is the question of notebook 13.
#
# ## Your turn
#
# Three exercises: the curvature of a curve, a curve *through* the waypoints, and slowing down only where it bends:
# [exercises/12_bsplines_and_feasibility_exercises.ipynb](exercises/12_bsplines_and_feasibility_exercises.ipynb).
