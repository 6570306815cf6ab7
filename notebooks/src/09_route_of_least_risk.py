# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 09 The route of least risk: how much safety does a detour buy?
#
# A drone that fails over a city falls on somebody, or on nobody. So it matters where it flies. Two papers say that
# little is needed: a route 7 % longer has 80 % less risk for the people below, and 15 % more length takes away 86 %. In
# this chapter we write a planner that finds the best route of its grid *for certain*. Then we ask four things. Safer
# than what? Is the map typical? Does the wreck land where the map says? And what would an authority count?
#
# | | |
# |---|---|
# | **You will be able to** | search exactly when moves depend on the heading and the length is limited; read a Pareto front; say what a "cut of 80 %" is measured against; say how far a falling wreck changes the answer; compute a ground risk class of SORA |
# | **You need** | chapters [05](05_astar.ipynb) (search) and [08](08_risk_maps.ipynb) (the risk $r$ of a place); nothing of aviation |
# | **Time** | 70 minutes to read, 30 seconds to run |
# | **Paper** | RISK-ACO, sections 2.3 and 4, Table 5 ([doi:10.19650/j.cnki.cjsi.J2007192](https://doi.org/10.19650/j.cnki.cjsi.J2007192)); PSO-BAS, Table 4 ([doi:10.23919/JSEE.2022.000111](https://doi.org/10.23919/JSEE.2022.000111)) |
#
# "Eq. 3" is an equation of this chapter, "RISK-ACO Eq. 3" one of the paper's.

# %%
import heapq
import itertools
import math
from dataclasses import replace

import numpy as np
from matplotlib.colors import LogNorm

from uavlab import plot, risk, scene
from uavlab.city import City
from uavlab.planners import least_risk, pareto_front
from uavlab.risk import CAMPUS_FLIGHT, RiskMap, random_campus, reference_campus
from uavlab.route import Route
from uavlab.statistics import over_maps, share_interval

campus = reference_campus()
start, goal = CAMPUS_FLIGHT  # (12.5, 17.5, 22.5) and (112.5, 112.5, 27.5) [m]

# %% [markdown]
# ## What we minimise
#
# Chapter 08 gave each voxel a risk $r$: the deaths that are expected in an hour of flight there. The *cost* of a route
# is
#
# $$ C = \frac{1}{\Delta x}\int r\,ds, \tag{1} $$
#
# where $\Delta x = 5$ m is the edge of a voxel and $s$ the length flown. On one map, at one speed $v$, it says the same
# as the deaths that a flight is expected to cause, $F = C\,\Delta x/(3600\,v)$: at our 16 m/s, $C = 10^{-5}$ per hour
# means one death in 1.2 billion flights. The papers add up $r$ over the voxels that a route passes, each once. We call
# that the *sum*. It has the scale of $C$, but a diagonal move through a voxel counts no more than a straight one.
#
# The *reference campus* is ours, 150 m × 150 m × 80 m. It was tuned until RISK-ACO's claim could be met on it. The
# papers' routes are over two real campuses, between other places.
#
# ## An exact search with headings
#
# RISK-ACO lets the UAV turn by at most 60° from one leg to the next. Seen from above, a move has one of eight headings,
# 45° apart. So 60° means: go straight on, or turn by 45°. Climb and descent have a limit of their own, also 60°, and
# that rules out the two vertical moves.
#
# Then a node, the centre of a voxel, doesn't say enough: which moves are allowed depends on where one came from. We
# search over **states** instead. A state is a node together with the heading in which the UAV arrived. (The start has
# no heading yet: `None`.)

# %%
MOVES = [move for move in itertools.product((-1, 0, 1), repeat=3) if move[:2] != (0, 0)]


def moves_from(rates, node, heading):
    """Each allowed move from a state: where it leads, its heading, its length [cells]."""
    x, y, z = node
    for dx, dy, dz in MOVES:
        allowed = heading is None or dx * heading[0] + dy * heading[1] > 0  # a turn by at most 45°
        box = itertools.product({x, x + dx}, {y, y + dy}, {z, z + dz})
        if allowed and all(voxel in rates for voxel in box):  # free
            yield (x + dx, y + dy, z + dz), (dx, dy), math.hypot(dx, dy, dz)


def octile(node, goal):
    """Length of the shortest way over 26 moves when nothing is in between [cells], as in chapter 05."""
    d3, d2, d1 = sorted(abs(u - v) for u, v in zip(node, goal, strict=True))
    return math.sqrt(3) * d3 + math.sqrt(2) * (d2 - d3) + (d1 - d2)


# %% [markdown]
# The second complication is a limit on the length. Suppose two ways lead to the same state. One is cheaper, the other
# shorter. Both may be needed: the cheap one is the better beginning, unless the rest of the way needs the metres that
# it has used up. So the search keeps **labels**. A label is a way to a state, with its cost and its length. We drop it
# in two cases:
#
# - Another label of its state costs no more and is no longer.
# - Its length plus the least that is still to go (the octile distance) is more than the limit.
#
# The labels leave the heap in the order of their cost, as in Dijkstra's search. So a later label of a state is worth
# keeping only if it is shorter than all earlier ones. The first label at the goal is the cheapest route within the
# limit.


# %%
def label_search(rates, start, goal, longest, cost_of, most_labels=math.inf):
    """Cost, length [cells] and nodes of the cheapest route within `longest`; the labels kept."""
    kept, number = {}, itertools.count()
    waiting = [(0.0, 0.0, next(number), [start], None)]
    while waiting:
        cost, length, _, nodes, heading = heapq.heappop(waiting)
        if nodes[-1] == goal:
            return cost, length, nodes, kept
        others = kept.setdefault((nodes[-1], heading), [])
        if len(others) == most_labels or any(length >= other - 1e-9 for _, other in others):
            continue  # another label of this state is cheaper, and no longer
        others.append((cost, length))
        for node, turned, step in moves_from(rates, nodes[-1], heading):
            if length + step + octile(node, goal) <= longest + 1e-9:
                more = cost_of(rates[nodes[-1]], rates[node], step)
                heapq.heappush(waiting, (cost + more, length + step, next(number), [*nodes, node], turned))
    return math.inf, math.inf, [], kept


# %% [markdown]
# We try it on a field of 11 by 7 cells, in a single layer. Most people are under trees ($p_s = 0.5$). On two *open
# patches* nobody is sheltered. There are 30 000 people per km², but on the first patch only 10 000: the *thin* one.

# %%
shelter, people = np.full((11, 7), 0.5), np.full((11, 7), 0.03)  # people per m²
shelter[2:5, 1:5] = shelter[6:9, 0:5] = 0.0
people[2:5, 1:5] = 0.01
field = RiskMap(City(np.zeros((11, 7, 1), bool), cell=5.0), people, shelter, safe_height=0.0)
west, east = (0, 2, 0), (10, 2, 0)


def by_integral(here, there, step):
    """Cost of a move by Eq. 1, half of it in each voxel."""
    return step * (here + there) / 2


def rates_of(risk_map):
    """The risk r of every voxel in which the UAV may fly."""
    return {node: risk_map.rate[node] for node in map(tuple, np.argwhere(risk_map.flyable).tolist())}


limits = (10.0, 11.7, 13.1, 13.7)  # cells
by_hand = {limit: label_search(rates_of(field), west, east, limit, by_integral) for limit in limits}

# %% tags=["nbval-check-output"]
for limit, (cost, length, _, kept) in by_hand.items():
    print(f"at most {limit} cells: C = {cost:.2e}, {length:.2f} cells, {sum(map(len, kept.values()))} labels kept")

# %% tags=["figure"]
paths = {
    f"at most {limit} cells: C = {cost:.1e}": field.city.center_of(np.array(nodes))[:, :2]
    for limit, (cost, _, nodes, _) in by_hand.items()
}
ends = {"start": field.city.center_of([west])[:, :2], "goal": field.city.center_of([east])[:, :2]}
plot.value_map(field.city, field.rate[:, :, 0], "risk r [deaths per hour]", norm=LogNorm(), paths=paths, points=ends,
               title="The cheapest routes through a field with two open patches",
               colors=dict(zip(paths, (plot.BLUE, plot.ORANGE, plot.PINK, plot.GREEN), strict=True)))  # fmt: skip

# %% [markdown]
# *Open patches: the two lighter rectangles; the left one is thin.* 11.7 cells are enough to go around the thin
# patch, but not around the full one. With 13.1 cells the best route cuts a corner of the thin patch, so that it has the
# metres to avoid the full one. With 13.7 it avoids both.
#
# > **Predict first.** Suppose that the search keeps one label for each state, the cheapest. At most 13.1 cells are
# > allowed. What goes wrong?

# %% tags=["nbval-check-output"]
hasty = label_search(rates_of(field), west, east, 13.1, by_integral, most_labels=1)
print(f"one label for each state: C = {hasty[0]:.2e}; all that are worth keeping: C = {by_hand[13.1][0]:.2e}")
state, labels = max(by_hand[13.1][3].items(), key=lambda item: len(item[1]))
print(f"at node {state[0]}, heading {state[1]}:", "; ".join(f"C = {c:.1e}, {n:.2f} cells" for c, n in labels))

# %% [markdown]
# It finds a route of two and a half times the cost. At the node (4, 5), just north of the thin patch, it keeps only the
# way around. That is the cheapest way to get there, but it has used up the metres for the second detour.
#
# Now the campus. The library's `least_risk` is the same search, compiled, with better lower bounds of what is still to
# come. RISK-ACO's route is $152.39/141.85 = 1.074$ times as long as its route without risk (its Table 5). We call the
# route of least $C$ that is at most 7.4 % longer than the shortest the **aware route**.

# %%
ALLOWED = {"RISK-ACO": 152.39 / 141.85, "PSO-BAS": 156.74 / 136.48}  # lengths, as printed
CLAIMED = {"RISK-ACO": 1 - 4.82e-6 / 2.37e-5, "PSO-BAS": 1 - 8.75e-7 / 6.45e-6}  # risks
LENGTH_ONLY = {"risk_weight": 0.0, "length_weight": 1.0}


def within(risk_map, length, **price):
    """The library's best route that is no longer than so many metres."""
    return least_risk(risk_map, start, goal, max_length=length + 1e-6, **price)


shortest_length = least_risk(campus, start, goal, **LENGTH_ONLY).length
longest = ALLOWED["RISK-ACO"] * shortest_length
aware, safest = within(campus, longest), least_risk(campus, start, goal)
begin, end = (tuple(campus.city.cell_of(place).tolist()) for place in (start, goal))
hand = label_search(rates_of(campus), begin, end, longest / campus.city.cell, by_integral)

# %% tags=["nbval-check-output"]
print(f"shortest {shortest_length:.2f} m; aware route, library: {aware.length:.2f} m, C = {aware.cost:.4e} per hour")
print(f"by hand: {hand[1] * campus.city.cell:.2f} m, C = {hand[0]:.4e}, {sum(map(len, hand[3].values()))} labels kept")
print(f"without a limit: {safest.length:.2f} m, C = {safest.cost:.4e}")
print(f"aware route: one death in {1 / campus.fatalities(aware) / 1e9:.1f} billion flights")

# %% tags=["check"]
for limit, (cost, length, _, _) in by_hand.items():
    ends_of_field = field.city.center_of([west, east])
    route = least_risk(field, *ends_of_field, max_length=limit * field.city.cell)
    assert math.isclose(route.cost, cost, rel_tol=1e-9)
    assert math.isclose(route.length, length * field.city.cell, rel_tol=1e-9)
assert math.isclose(hand[0], aware.cost, rel_tol=1e-9)
assert round(hasty[0] / by_hand[13.1][0], 1) == 2.5
assert round(3600 * 16 / 5 / 1e-5 / 1e9, 1) == 1.2
crossed = {limit: {tuple(node[:2]) for node in nodes} for limit, (_, _, nodes, _) in by_hand.items()}
thin = {(x, y) for x in (2, 3, 4) for y in (1, 2, 3, 4)}
full = {(x, y) for x in (6, 7, 8) for y in (0, 1, 2, 3, 4)}
assert [(bool(crossed[limit] & thin), bool(crossed[limit] & full)) for limit in limits] == [
    (True, True), (False, True), (True, False), (False, False)]  # fmt: skip

# %% [markdown]
# ## Safer than what?
#
# A cut needs something to be compared with. The papers take the route of least $J_0 = \omega_1 L + \omega_2 J_s$,
# planned without risk. Here $L$ is its length (their $J_l$), $\omega_1 = 0.5$ and $\omega_2 = 0.2$ (Table 3 of both),
# and $J_s$ is a *threat* of buildings. RISK-ACO Eq. 1 has $J_s = f_1/\min D_b$ for a single building: a strength $f_1$
# over the least distance to its centre (stretched where it isn't square). A minimum can't be added up from move to
# move. So we add up along the whole way, over the buildings that are higher than the UAV:
#
# $$ J_s = \frac{1}{\Delta x}\int \sum_\text{buildings} \frac{f_1}{\max(D_b, 1\text{ m})}\,ds. \tag{2} $$
#
# The text that we have gives no $f_1$. We take 0, 100 and 500 m², to see how much hangs on it. With 100, a metre costs
# 0.4 for the threat of a building 10 m away, and 0.5 for the length. With 0, $J_0$ is the length alone.
#
# But there isn't *one* shortest route. To the goal it is 20 cells east, 19 north and 1 up. That takes 18 level diagonal
# moves, one that climbs, and one straight one, in any of $20\cdot19 = 380$ orders. On this campus all are allowed.


# %%
def arranged(climbing, straight):
    """The shortest route whose move of one number climbs, and whose move of the other goes straight east."""
    moves = np.tile((1, 1, 0), (20, 1))
    moves[climbing, 2], moves[straight, 1] = 1, 0
    nodes = begin + np.vstack([np.zeros((1, 3), int), np.cumsum(moves, axis=0)])
    return Route(campus.city.center_of(nodes), "shortest")


equal = [arranged(*numbers) for numbers in itertools.permutations(range(20), 2)]
equal_costs = np.array([campus.integral(route) for route in equal])
shortest = within(campus, shortest_length)  # the least risky of the shortest

# %% tags=["nbval-check-output"]
print(f"{len(equal)} routes of {equal[0].length:.2f} m: C from {equal_costs.min():.2e} to {equal_costs.max():.2e}")
for name, cost in {"least risky": shortest.cost, "riskiest": equal_costs.max()}.items():
    print(f"the aware route has {1 - aware.cost / cost:.1%} less C than the {name} of them")

# %% [markdown]
# They differ by a factor of 1.6. A fair comparison takes the *least risky* of them, since it costs not a single metre.
# That is our rule from here on.
#
# The papers compare sums. We can plan by sums exactly, too. With `drift=True` (which we need below) the library takes
# another price for each of the 26 moves. We hand it $r$ divided by the length of the move. Then each move costs the
# mean of its two $r$, however long it is. That adds up to the papers' sum, but for half of $r$ at both ends.


# %%
class BySums(RiskMap):
    """A risk map on which `least_risk(..., drift=True)` finds the least sum."""

    @property
    def rate_ahead(self):
        moves = [move for move in itertools.product((-1, 0, 1), repeat=3) if any(move)]
        return np.stack([self.rate / math.hypot(*move) for move in moves])


# %%
def cuts_by_sums(risk_map, strength):
    """The route of least J0 (of equal ones that of the least sum), and the cuts by sums."""
    layers = risk_map.city, risk_map.population_density, risk_map.shelter, risk_map.vehicle_share
    summed = BySums(*layers, min_height=risk_map.min_height)
    weights = {"length_weight": 0.5, "threat_weight": 0.2 * strength / 100}  # threat: for 100 m²
    blind = least_risk(risk_map, start, goal, risk_weight=0.0, **weights)
    if strength == 0:
        blind = within(summed, blind.length, drift=True)
    routes = [within(summed, ratio * blind.length, drift=True) for ratio in ALLOWED.values()]
    return blind, [1 - risk_map.cell_sum(route) / risk_map.cell_sum(blind) for route in routes]


STRENGTHS = (0, 100, 500)  # f1 [m²]
on_reference = {strength: cuts_by_sums(campus, strength) for strength in STRENGTHS}

# %% tags=["nbval-check-output"]
for paper, ratio in ALLOWED.items():
    print(f"{paper} claims −{CLAIMED[paper]:.1%} for {ratio - 1:+.1%} of length")
for strength, (blind, cuts) in on_reference.items():
    print(f"sums, f1 = {strength:3} m²: −{cuts[0]:.1%} and −{cuts[1]:.1%}, against a route of {blind.length:.1f} m")
cuts = [1 - within(campus, ratio * shortest_length).cost / shortest.cost for ratio in ALLOWED.values()]
print(f"C: −{cuts[0]:.1%} and −{cuts[1]:.1%}, against the least risky shortest route")

# %% [markdown]
# RISK-ACO's −80 % can be had here, on the campus that was tuned to it, with $f_1$ of 0 and 100 m², but not with 500.
# That $J_0$ route has only a third of the sum of the one for 100 m², so less is left to gain. PSO-BAS's −86 % can be
# had with none of the three. These are the largest cuts of all routes on the grid that enter no voxel twice. But the
# papers' $f_1$ isn't known, and their $J_s$ is a minimum. So their comparison itself can't be repeated.

# %% tags=["figure"]
COLORS = {
    "shortest, least risky": plot.BLUE, "shortest, riskiest": plot.ORANGE, "J0 with 100 m²": plot.PINK,
    "aware, at most +7.4 %": plot.GREEN, "drift-aware, at most +7.4 %": plot.SKY, "Pareto front": plot.BLACK,
}  # fmt: skip
drawn = {"shortest, least risky": shortest, "shortest, riskiest": equal[equal_costs.argmax()],
         "J0 with 100 m²": on_reference[100][0], "aware, at most +7.4 %": aware}  # fmt: skip
drawn = {name: replace(route, planner=name, cost=campus.integral(route)) for name, route in drawn.items()}
scene.show(campus.city, *drawn.values(), risk=campus, uav=campus.uav, colors=COLORS)

# %% [markdown]
# *The reference campus, with the risk just above the ground. Yellow: open patches, where many people have no shelter.*
# The aware route turns out of the way of two of them. The $J_0$ route climbs above the roofs, where no building is a
# threat.

# %% tags=["check"]
assert len(equal) == 380
assert np.allclose([route.length for route in equal], shortest_length)
nodes = campus.city.cell_of(np.array([route.points for route in equal]).reshape(-1, 3))
assert campus.flyable[tuple(nodes.T)].all()
assert math.isclose(shortest.cost, equal_costs.min(), rel_tol=1e-9)
assert round(equal_costs.max() / equal_costs.min(), 1) == 1.6
by_sum = label_search(rates_of(campus), begin, end, longest / campus.city.cell, lambda a, b, step: (a + b) / 2)
blind, (cut, _) = on_reference[0]
ends_by_half = (campus.rate[begin] + campus.rate[end]) / 2
ratio_of_sums = campus.cell_sum(on_reference[500][0]) / campus.cell_sum(on_reference[100][0])
assert 0.32 < ratio_of_sums < 0.34
assert math.isclose(by_sum[0] + ends_by_half, (1 - cut) * campus.cell_sum(blind), rel_tol=1e-9)
assert round(on_reference[100][0].points[:, 2].max()) > max(b.bounds[1, 2] for b in campus.city.buildings)

# %% [markdown]
# ## How much safety for how many metres?
#
# A route is *Pareto-optimal* if no other one is better in length or in risk without being worse in the other. All of
# these together are the **Pareto front**. The search with labels finds them one by one, each for a limit on the length;
# `pareto_front` does so.
#
# > **Predict first.** Without any limit the route of least risk is 34 % longer than the shortest. How much longer must
# > a route be to have half of the risk?

# %%
front = pareto_front(campus, start, goal, lengths=60)  # 60 limits, evenly from the shortest to the safest
steps = [(route.length / front[0].length - 1, 1 - route.cost / front[0].cost) for route in front]

# %% tags=["nbval-check-output"]
for share in (0.5, 0.8, 0.86):
    longer, cut = next(step for step in steps if step[1] >= share)
    print(f"risk at least {share:.0%} less than the least risky shortest: {longer:+.1%} of length (cut {cut:.1%})")
print(f"the end of the front: {steps[-1][0]:+.1%} of length, cut {steps[-1][1]:.1%}")

# %% tags=["figure"]
others = (drawn[name] for name in ("shortest, riskiest", "J0 with 100 m²", "aware, at most +7.4 %"))
figure = plot.front(front, *others, label="cost C [1/h], logarithmic", colors=COLORS)
figure.axes[0].set_title("The least risk for each length, and other routes")
figure

# %% [markdown]
# *Each black dot is the least risk within its length, for sixty limits; some lie only a little lower than their left
# neighbour.* On this campus half of the risk costs 2.1 % of length, and four fifths cost 4.5 %. From 86.2 to 87.0 % it
# is another 17.5 %.


# %% tags=["figure"]
def at_most(extra):
    """The risk map with the best route for so much additional length [%]."""
    route = within(campus, (1 + extra / 100) * shortest_length)
    name = f"at most +{extra:g} %: C = {route.cost:.1e} per hour"
    look = COLORS | {name: plot.GREEN}
    return plot.risk(campus, 27.5, drawn["shortest, least risky"], replace(route, planner=name), colors=look)


labels, extra = {"extra": "additional length [%]"}, (0.0, 2.5, 5.0, 7.5, 10.0, 15.0, 20.0, 35.0)
plot.sliders(at_most, title="least risk", labels=labels, start={"extra": 5.0}, progress=False, extra=extra)

# %% [markdown]
# *The best route for a chosen additional length, and the least risky shortest one, from above.* Move the slider: which
# open patch does the route leave first? (The eastern one, at +2.5 %; at +5 % it has left both.)
#
# > **Try it.** Let the UAV turn as sharply as it likes. How much risk does the limit on turns cost?

# %% tags=["try-it"]
any_turn = least_risk(campus, start, goal, max_turn=np.pi)
print(f"any turns: {any_turn.length:.1f} m, C = {any_turn.cost:.3e}; turns of at most 60°: C = {safest.cost:.3e}")

# %% tags=["check"]
patch = (campus.shelter == 0) & (campus.vehicle_share == 0)
east_of_70 = patch & (np.arange(30)[:, None] >= 14)
for extra, (over_any, over_east) in {0.0: (True, True), 2.5: (True, False), 5.0: (False, False)}.items():
    passed, inside = within(campus, (1 + extra / 100) * shortest_length).voxels(campus.city)
    columns = tuple(passed[inside > 1e-6][:, :2].T)
    assert (patch[columns].any(), east_of_70[columns].any()) == (over_any, over_east)

# %% [markdown]
# Only 0.6 %. Without limits on turns and length the route becomes 47 m longer to gain it.
#
# ## Is the campus typical?
#
# A map that was tuned to a claim can show that it is possible, no more. So we draw forty campuses at random
# (`random_campus`, seeds 0 to 39; forty is our choice, to keep the run short), with the same roads, start and goal, but
# other blocks, buildings and people. The loop also stores what the next section needs.


# %%
def studied(risk_map):
    """Of a campus: cuts by sums and by C, and true risks (next section), for both papers' lengths."""
    length = least_risk(risk_map, start, goal, **LENGTH_ONLY).length
    found = {f"sums, f1 = {strength} m²": cuts_by_sums(risk_map, strength)[1] for strength in STRENGTHS}
    blind, *aware = (within(risk_map, ratio * length) for ratio in (1, *ALLOWED.values()))
    found["C"] = [1 - route.cost / blind.cost for route in aware]
    found["most"] = 1 - least_risk(risk_map, start, goal).cost / blind.cost  # for any length
    least, *knowing = (within(risk_map, ratio * length, drift=True).cost for ratio in (1, *ALLOWED.values()))
    found["true, aware"] = [risk_map.integral(route, drift=True) / least for route in aware]
    found["true, drift-aware"] = [cost / least for cost in knowing]
    return found


campuses = [studied(random_campus(seed)) for seed in range(40)]
forty = {name: np.array([found[name] for found in campuses]) for name in campuses[0]}  # name → (campus, paper)


# %%
def median(values):
    """Median over the campuses, and its 95 % interval by drawing the campuses again and again."""
    low, high = over_maps(np.median, values[:, None])
    return f"{np.median(values):.0%} [{low:.0%}, {high:.0%}]"


def how_many(those):
    """On how many of the campuses, with the 95 % interval of the share among all such campuses."""
    low, high = share_interval(int(those.sum()), 40)
    return f"{those.sum()} of 40 [{low:.0%}, {high:.0%}]"


# %% tags=["nbval-check-output"]
MEASURES = ("C", *(f"sums, f1 = {strength} m²" for strength in STRENGTHS))
for at, (paper, claim) in enumerate(CLAIMED.items()):
    print(f"{paper} claims −{claim:.1%} for {ALLOWED[paper] - 1:+.1%} of length")
    for measure in MEASURES:
        cut = forty[measure][:, at]
        print(f"    {measure:<19}: median −{median(cut)}, claim reached on {how_many(cut >= claim)}")
print("of the cut that any length could buy, the aware route has", median(forty["C"][:, 0] / forty["most"]))

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 2, share="y", width=11.0, height=3.6)
for at, (axes, (paper, ratio)) in enumerate(zip(panels, ALLOWED.items(), strict=True)):
    claim = f"claimed: {CLAIMED[paper]:.1%}"
    shown = {"forty campuses": {measure: 100 * forty[measure][:, at] for measure in MEASURES}}
    plot.runs(shown, "cut of the risk [%]", x_range=(0, 100), places={claim: 100 * CLAIMED[paper]}, axes=axes,
              colors={claim: plot.ORANGE}, title=f"{paper}, {ratio - 1:+.1%} of length")  # fmt: skip
plot.finished(figure)

# %% [markdown]
# *Each stroke ("run") is a campus; the large marks are medians.* The claims are possible, but in no row do more than 14
# of the forty campuses reach them. In six of the eight rows the interval, too, lies below one half: fewer than half of
# *all* such campuses reach the claim. For RISK-ACO's sums with 100 and 500 m², up to 52 %, that isn't shown.
#
# ## It doesn't fall straight down
#
# So far a failing UAV was taken to fall on the ground straight below, as in the papers. But it flies at 16 m/s, and the
# full fall of chapter 08 (its Eq. 2) keeps most of that speed:

# %% tags=["nbval-check-output"]
for height in (17.5, 27.5, 37.5):
    fall = risk.ballistic_fall(height)
    print(f"from {height} m: {fall.duration:.1f} s, lands {fall.drift:.0f} m ahead, {fall.drift / 5:.1f} voxels")

# %% [markdown]
# The wreck lands about seven voxels ahead. We call this the *drift*. The risk then belongs to a place $\mathbf x$ *and*
# a direction of flight $\mathbf u$:
#
# $$ r_\text{true}(\mathbf x, \mathbf u) = f_c\,n_p\,A_\text{exp}\,P_\text{die} + r_\text{cars} \tag{3} $$
#
# with the people, shelter and cars of the place where the fall from $\mathbf x$ along $\mathbf u$ ends: on the ground,
# on a roof or against a wall. Area $A_\text{exp}$ and chance $P_\text{die}$ are those of the full fall, which is slower
# on impact than the papers': that alone makes the part of the people 5 to 15 % smaller. "True" means no more than this:
# in still air, with the papers' small drag area (0.0056 m²; chapter 08 has larger ones), without braking before the
# goal, and with ground beyond the map as at its edge.
#
# The states know the heading, so the search needs only another price: `drift=True`. By our rule, true risks are
# compared with the *truly* least risky of the equally short routes.
#
# > **Predict first.** Our aware route claims a cut of 83 %. How much of that is left if the wreck drifts? And how much
# > could a planner reach that knows of the drift?

# %%
drift_aware = within(campus, longest, drift=True)
truly_least = within(campus, shortest_length, drift=True)

# %% tags=["nbval-check-output"]
for name, route in {"best of the shortest": truly_least, "aware": aware, "drift-aware": drift_aware}.items():
    true = campus.integral(route, drift=True)
    print(f"{name:<20} {route.length:.1f} m: C = {campus.integral(route):.2e} straight below,", end=" ")
    print(f"{true:.2e} true ({true / truly_least.cost:.0%})")

# %% [markdown]
# Half of the promise is left, a cut of 42 %. A planner that knows of the drift reaches 77 % within the same length. The
# same on the forty campuses:

# %% tags=["nbval-check-output"]
at_once, later = forty["true, aware"][:, 0], forty["true, drift-aware"]
print(f"+7.4 %, aware: true risk {median(at_once)} of the best shortest; riskier than it on {how_many(at_once > 1)}")
for at, (paper, ratio) in enumerate(ALLOWED.items()):
    cut = 1 - later[:, at]
    print(
        f"{ratio - 1:+.1%}, drift-aware: cut {median(cut)}; {CLAIMED[paper]:.1%} or more on",
        how_many(cut >= CLAIMED[paper]),
    )

# %% tags=["figure"]
rows = {"aware: claimed": 1 - forty["C"][:, 0], "aware: true": at_once, "drift-aware: true": later[:, 0]}
plot.runs({"forty campuses, +7.4 % of length": rows}, "risk, times that of the least risky shortest route",
          log=True, places={"no gain": 1.0}, colors={"no gain": plot.ORANGE},
          title="What is left of the cut when the wreck drifts")  # fmt: skip

# %% [markdown]
# *Each stroke is a campus; the large marks are medians. Right of the line the route is riskier than the best of the
# shortest.* A gain is no longer shown: the median of the true risk is 112 %, with an interval from 78 to 147 %. On 23
# of the forty campuses the "aware" route is riskier than a route that costs no additional metre. With drift in the
# price the median cut is 74 %, and with PSO-BAS's length 89 %. Back on the reference campus:


# %% tags=["figure"]
def landing(city, point, leg):
    """Where the wreck comes to rest that fails at a point and flies along a leg (east, north) [m]; if off the map."""
    level = np.hypot(*leg[:2])
    lost = np.linspace(0.0, point[2], 200)
    drift = risk.ballistic_fall(lost, pitch=np.arctan2(leg[2], level)).drift
    way = np.column_stack([point[:2] + drift[:, None] * leg[:2] / level, point[2] - lost])
    inside = city.inside(way)
    hit = inside.copy()
    hit[inside] = ~city.is_free(way[inside])
    return way[hit.argmax() if hit.any() else -1, :2]


def falls(route):
    """Of each leg: its middle, where a wreck from there lands, and the leg's part of the true C."""
    pairs = list(itertools.pairwise(route.points))
    places = [(a + b)[:2] / 2 for a, b in pairs], [landing(campus.city, (a + b) / 2, b - a) for a, b in pairs]
    return *map(np.array, places), np.array([campus.integral(Route(pair), drift=True) for pair in pairs])


# %% tags=["figure"]
figure, panels = plot.new_panels(1, 2, share="y", width=11.0, height=5.6)
norm, look = LogNorm(), COLORS | {"fall": plot.PINK, "lands": "0.8", "lands, part of C above 3e-6": plot.ORANGE}
two = {"aware, at most +7.4 %": aware, "drift-aware, at most +7.4 %": drift_aware}
for axes, (name, route) in zip(panels, two.items(), strict=True):
    middles, rest, parts = falls(route)
    bad = parts > 3e-6
    ways = np.stack([middles, rest, np.full_like(rest, np.nan)], axis=1)[bad].reshape(-1, 2)
    plot.value_map(campus.city, plot.ground_risk(campus), "risk just above the ground [deaths per hour]", norm=norm,
                   paths={"fall": ways, name: route.points[:, :2]}, axes=axes, colors=look,
                   points={"start": route.points[:1, :2], "goal": route.points[-1:, :2], "lands": rest[~bad],
                           "lands, part of C above 3e-6": rest[bad]},
                   title=f"{name[:-16]}: true C = {parts.sum():.1e} per hour")  # fmt: skip
plot.finished(figure)

# %% [markdown]
# *Marks: where the wreck lands that fails in the middle of a leg. Orange: the legs with the largest part of C, with
# their falls.* The aware route turns away from two open patches but flies *towards* two: four of its 23 legs carry 78 %
# of its true $C$. The drift-aware route has one such leg.

# %% tags=["check"]
at_80, at_86 = (next(step for step in steps if step[1] >= share) for share in (0.8, 0.86))
assert [round(100 * value, 1) for value in (at_80[0], steps[-1][0], steps[-1][0] - at_86[0])] == [4.5, 34.1, 17.5]
any_turns = least_risk(campus, start, goal, max_turn=np.pi)
assert [round(100 * (safest.cost / any_turns.cost - 1), 1), round(any_turns.length - safest.length)] == [0.6, 47]
reached = {m: [int((forty[m][:, at] >= claim).sum()) for at, claim in enumerate(CLAIMED.values())] for m in MEASURES}
assert reached == dict(zip(MEASURES, ([10, 12], [9, 8], [14, 9], [14, 5]), strict=True))
assert sum(share_interval(count, 40)[1] < 0.5 for pair in reached.values() for count in pair) == 6
parts, parts_aware = falls(drift_aware)[2], falls(aware)[2]
assert ((parts > 3e-6).sum(), (parts_aware > 3e-6).sum(), len(parts_aware)) == (1, 4, 23)
assert round(100 * parts_aware[parts_aware > 3e-6].sum() / parts_aware.sum()) == 78
for height, shelter_here in itertools.product((17.5, 27.5, 37.5), (0.0, 0.25, 0.5, 0.75)):
    lethal = []
    for speeds in ((16.0, float(risk.fall_speed(height))), risk.ballistic_fall(height)[2:]):
        energy = risk.impact_energy(campus.uav.mass, *speeds)
        lethal.append(risk.lethal_area(height, *speeds) * risk.impact_fatality(energy, shelter_here))
    assert 0.85 <= round(float(lethal[1] / lethal[0]), 2) <= 0.95

# %% [markdown]
# ## What an authority counts: SORA
#
# Authorities judge flights over people by SORA (*Specific Operations Risk Assessment*, edition 2.5, 2024, by JARUS, an
# association of authorities). We look at its first measure of the danger on the ground, one of ten steps. This is no
# legal advice.
#
# Let a UAV fail $f_c$ times per hour over $n_p$ people per m², and let each crash kill everybody on a *critical area*
# $A_c$. Then $f_c\,n_p\,A_c$ people die per hour, which is a risk like $r$. (It is not like $C$: along a route of
# length $L$ the mean risk is $C\,\Delta x/L$.) SORA allows a *target level of safety* of $\text{TLOS} = 10^{-6}$ deaths
# per hour. So $f_c \le \text{TLOS}/(n_p A_c)$. The power of ten of that bound gives an *intrinsic ground risk class*:
#
# $$ \text{iGRC} = 1 - \log_{10}\frac{\text{TLOS}}{n_p\,A_c}, \qquad f_c \le 10^{1 - \text{iGRC}} \text{ per hour.}
#    \tag{4} $$
#
# A UAV of class $n$ may fail once in $10^{n-1}$ hours. In practice a table gives the class. These are its first three
# columns (Table 2 of SORA's main body; $A_c$ from its Annex F):
#
# | people per km² | up to 1 m and 25 m/s, $A_c = 8$ m² | up to 3 m and 35 m/s, 80 m² | up to 8 m and 75 m/s, 800 m² |
# |---|---|---|---|
# | nobody but those who take part | 1 | 1 | 2 |
# | below 5 | 2 | 3 | 4 |
# | below 50 | 3 | 4 | 5 |
# | below 500 | 4 | 5 | 6 |
# | below 5 000 | 5 | 6 | 7 |
# | below 50 000 | 6 | 7 | 8 |
# | 50 000 and more | 7 | 8 | – |
#
# Our UAV (0.4 m, 16 m/s) belongs in the first column. Classes above 7 are outside of what SORA is made for.
#
# > **Predict first.** On the campus 89 % of the voxels have a risk below $10^{-6}$ deaths per hour, which is TLOS. Which
# > classes will its ground have: 1 to 3, or higher?

# %%
classes = campus.igrc  # by the table, for each cell of the ground
rate = campus.rate[campus.flyable]
fall_speed = float(risk.fall_speed(30.0))
area = float(risk.lethal_area(30.0, 16.0, fall_speed))  # chapter 08, Eq. 6
kills = float(risk.impact_fatality(risk.impact_energy(campus.uav.mass, 16.0, fall_speed), 0.5))  # Eq. 7
people_there, failures = 0.03, 6.4e-5  # per m², per hour: Table 2 of both papers
deaths = {"papers": failures * people_there * area * kills, "SORA": failures * people_there * 8.0 * 1.0}

# %% tags=["nbval-check-output"]
print("share of the ground:", ", ".join(f"class {c} {np.mean(classes == c):.0%}" for c in np.unique(classes)))
print(f"share of flyable voxels with r below 1e-6 per hour: {np.mean(rate < 1e-6):.0%}")
print(f"papers {deaths['papers']:.1e}, SORA {deaths['SORA']:.1e} deaths per hour: a factor of", end=" ")
print(f"{8 / area:.2f} for the area × {1 / kills:.1f} for the blow = {deaths['SORA'] / deaths['papers']:.0f}")
print(f"iGRC by Eq. 4: {risk.raw_igrc(0.03, 8.0):.1f}, by the table {risk.igrc(0.03, 0.4, 16.0)};", end=" ")
print(f"TLOS allows {risk.tolerable_failure_rate(0.03, 8.0):.1e} failures per hour")

# %% [markdown]
# Class 5 to 7. Both start from one balance. Here it is for a place with 30 000 people per km² under trees, 30 m below:
#
# | factor | papers | SORA | SORA / papers |
# |---|---|---|---|
# | failures per hour $f_c$ (the papers' value in both) | $6.4\cdot10^{-5}$ | $6.4\cdot10^{-5}$ | 1 |
# | people per m², $n_p$ | 0.03 | 0.03 | 1 |
# | area on which people are hit | 1.65 m² | 8 m² | 4.84 |
# | chance that a blow kills | 2.3 % | 100 % | 43.5 |
# | **deaths per hour (the product)** | $7.3\cdot10^{-8}$ | $1.5\cdot10^{-5}$ | **211** |
#
# The papers' number is 14 times below TLOS, and SORA's is 15 times above it. The papers count shelter as known; the
# table grants none. SORA also doesn't assume a rate of failures: it *demands* one. By class 6 the UAV may fail once in
# $10^5$ hours. (By TLOS itself once in 240 000: the table rounds 6.4 down.) The papers' $f_c$ is 6.4 times as high.
#
# The class of a flight is the highest below it and within a *ground risk buffer* beside it. By SORA's simplest rule the
# buffer reaches as far as the flight is high, plus half the UAV's size: 30.2 m for a flight at 30 m. With that, *every*
# cell of the campus has class 7, and no detour can change it. There the class demands a more reliable UAV, and the
# papers' map can still choose among routes. (On larger maps `max_igrc=6` keeps a planner to class 6.)
#
# > **Try it.** Which class does the table give a UAV of 2 m over the same 30 000 people per km²? And one of 0.4 m that
# > flies at 36 m/s?

# %% tags=["try-it"]
print("0.4 m, 16 m/s:", risk.igrc(0.03, 0.4, 16.0))
print("2 m, 16 m/s:", risk.igrc(0.03, 2.0, 16.0), "and 0.4 m, 36 m/s:", risk.igrc(0.03, 0.4, 36.0))

# %% tags=["check"]
printed = [[1, 1, 2], [2, 3, 4], [3, 4, 5], [4, 5, 6], [5, 6, 7], [6, 7, 8], [7, 8, risk.sora.NO_CLASS]]
assert risk.sora.IGRC[:, :3].tolist() == printed
assert (risk.sora.DIMENSIONS[:3], risk.sora.SPEEDS[:3]) == ((1.0, 3.0, 8.0), (25.0, 35.0, 75.0))
assert (risk.sora.DENSITIES, risk.sora.CRITICAL_AREAS[:3]) == ((5.0, 50.0, 500.0, 5000.0, 50000.0), (8.0, 80.0, 800.0))
assert [round(1e-6 / deaths["papers"]), round(deaths["SORA"] / 1e-6)] == [14, 15]
assert round(deaths["SORA"] / deaths["papers"]) == 211
assert round(1 / risk.tolerable_failure_rate(0.03, 8.0)) == 240_000
assert math.isclose(risk.ground_risk_buffer(30.0, 0.4), 30.2)
assert campus.igrc_within(30.2).min() == 7 == classes.max()

# %% [markdown]
# ## Remember
#
# - If moves depend on the heading, search over states: node and heading.
# - If the length is limited, keep labels. A label is dropped when another one of its state costs no more and is no
#   longer.
# - A cut of 80 % means nothing without the baseline, the measure and the map. Of equally short routes, the least risky
#   is the baseline.
# - On forty random campuses, with the wreck straight below, 7.4 % of length bought 85 % [79 %, 93 %] of the cut that any
#   length could buy.
# - But a wreck lands 30 to 40 m ahead. Then no gain of those routes is shown. A planner that knows of it cuts 74 %
#   [61 %, 83 %] for the same length.
# - SORA's class and the papers' risk are one balance with different factors: area, chance to kill, and a rate of
#   failures that is demanded, not assumed.
#
# ## What the paper says, what we find
#
# | papers | say | we find |
# |---|---|---|
# | RISK-ACO Table 5 | −80 % of risk (4.82·10⁻⁶ for 2.37·10⁻⁵) for +7.4 % of length | *possible; not shown to be typical by sums, not typical by $C$.* Largest cut of the sum on the reference campus, which was tuned to the claim: 81, 81 and 48 % with $f_1$ = 0, 100 and 500 m². Reached on 9, 14 and 14 of 40 random ones (intervals 11–38, 21–52, 21–52 %); by $C$ on 10 [13 %, 41 %] |
# | PSO-BAS Table 4 | −86 % (8.75·10⁻⁷ for 6.45·10⁻⁶) for +14.8 % | *possible, not typical.* Largest cut of the sum on the reference campus: 83, 82 and 48 %. Reached on 8, 9 and 5 of 40 (9–36, 11–38, 4–27 %); by $C$ on 12 [17 %, 47 %] |
# | RISK-ACO Eq. 1: $J_s$ | a threat, without $f_1$ in the text that we have | the baseline $J_0$, and with it the cut, depends on $f_1$. Theirs can't be repeated |
# | both: landing | straight below | 29 to 42 m ahead from 17.5 to 37.5 m. True risk of the aware route: 112 % [78 %, 147 %] of the truly least risky shortest; riskier than it on 23 of 40 [41 %, 73 %] |
# | | | with drift in the price: −74 % [61 %, 83 %] for +7.4 %, −89 % [77 %, 92 %] for +14.8 %; the claims' numbers on 16 [25 %, 57 %] and 22 of 40 [38 %, 71 %] (by $C$ true, another measure than theirs) |
# | both: acceptable? | no level is named in the text that we have | 89 % of the voxels below SORA's TLOS by the papers' factors, yet class 5 to 7; with a buffer of 30.2 m class 7 everywhere |
#
# "Typical" means: for campuses like our random ones. Whether the papers' own planners find such routes is another
# question, for chapters [10](10_ant_colony.ipynb) and [11](11_particle_swarm_and_beetles.ipynb).
#
# ## Read on
#
# - S. Irnich, G. Desaulniers, "Shortest path problems with resource constraints", in *Column Generation*, Springer
#   2005, ISBN 978-0-387-25486-9: labels and when to drop them, in general.
# - Y. Haimes, L. Lasdon, D. Wismer, "On a bicriterion formulation of the problems of integrated system identification
#   and system optimization", *IEEE Transactions on Systems, Man, and Cybernetics* 1 (1971),
#   [doi:10.1109/TSMC.1971.4308298](https://doi.org/10.1109/TSMC.1971.4308298): fronts by one limit after another.
# - S. Primatesta, G. Guglieri, A. Rizzo, "A risk-aware path planning strategy for UAVs in urban environments", *Journal
#   of Intelligent & Robotic Systems* 95 (2019),
#   [doi:10.1007/s10846-018-0924-3](https://doi.org/10.1007/s10846-018-0924-3): another risk map, with a variant of A\*.
# - "Risk-aware UAV trajectory optimization using open urban GIS data and target level of safety constraints", *Drones*
#   9 (2025) 666, [doi:10.3390/drones9100666](https://doi.org/10.3390/drones9100666): falls ahead of the UAV, wind and
#   TLOS in one search.
# - JARUS, *Guidelines on SORA*, edition 2.5 (2024), [jarus-rpas.org/publications](http://jarus-rpas.org/publications):
#   main body with the table, Annex F with the balance of Eq. 4.
#
# ## Your turn
#
# Six exercises: a question on labels, a ground risk class, a filter for labels, a search to repair, a front to read, and
# an abstract that is true and misleads:
# [exercises/09_route_of_least_risk_exercises.ipynb](exercises/09_route_of_least_risk_exercises.ipynb).
#
# Before: [08 Risk maps](08_risk_maps.ipynb). Next: [10 Ant colony](10_ant_colony.ipynb).
