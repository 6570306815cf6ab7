# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 11 Particle swarm and beetles: can a swarm find the route of least risk?
#
# An exact search finds the route of least risk, but only among chains of moves from voxel to voxel. A free curve may
# be better. All coordinates of its waypoints together are *one* point in a space of many dimensions, and a swarm can
# search that space. Each particle remembers the best point that it has met, and all know the best point of the swarm.
# The paper PSO-BAS also gives each particle the two antennae of a beetle. It reports less risk than with a plain swarm
# or with ants, after 55 iterations. How near to the optimum does such a swarm come, and which of its parts help?
#
# | | |
# |---|---|
# | **You will be able to** | turn a route into a point; write a particle swarm and say for which settings it comes to rest; say how far a beetle can walk; compare random planners fairly |
# | **You need** | chapters [08](08_risk_maps.ipynb) (risk maps), [09](09_route_of_least_risk.ipynb) (the exact optimum) and [10](10_ant_colony.ipynb) (ants, refinement); variance; eigenvalues |
# | **Time** | 85 minutes to read, 45 seconds to run |
# | **Paper** | PSO-BAS, section 4, Table 3, Figs 9 and 10 ([doi:10.23919/JSEE.2022.000111](https://doi.org/10.23919/JSEE.2022.000111)) |
#
# PSO is *particle swarm optimisation*, BAS *beetle antennae search*, ACO *ant colony optimisation*. "Eq. 3" is an
# equation of this chapter, "PSO-BAS Eq. 16" one of the paper's. *Printed* means: by the paper's formulas and numbers,
# as far as the text that we have gives them.

# %%
from functools import partial
from itertools import product

import numpy as np

from uavlab import plot
from uavlab.optimizers import bas, pso, pso_bas
from uavlab.optimizers.particle_swarm import stability
from uavlab.planners import ant_colony, compare_planners, least_risk, optimality_gap, refine, waypoint_swarm
from uavlab.risk import CAMPUS_FLIGHT, random_campus
from uavlab.route import Route
from uavlab.spline import cubic_bspline
from uavlab.statistics import over_maps, share_interval

# %% [markdown]
# ## A route as one point
#
# A campus consists of *voxels*, cubes with an edge $\Delta x$ of 5 m. Each has a risk $r$: the deaths on the ground to
# be expected per hour of flight in it (chapter 08). A route's **cost** is its risk, added up along the way:
#
# $$ C = \frac{1}{\Delta x} \int r\, ds. \tag{1} $$
#
# Only ratios of costs count here. Chapter 09 finds the least cost among chains of moves, each to one of 26 neighbours.
# The **gap** of a route is its cost divided by this optimum, minus 1. The gap of a free curve can be negative. Our 12
# campuses are drawn at random, independently of each other.
#
# Now take $K = 7$ waypoints (our choice) between start and goal. Their coordinates are a point $\mathbf x$ in $D = 21$
# dimensions. The route is a *cubic B-spline*, a smooth curve that follows its waypoints without going through them
# (chapter 12).


# %%
start, goal = CAMPUS_FLIGHT
campuses = [random_campus(seed) for seed in range(12)]
optima = [least_risk(campus, start, goal) for campus in campuses]


def curve(x):
    """The route of a point x, (21,)."""
    control = np.concatenate([[start], x.reshape(7, 3), [goal]])
    return Route(cubic_bspline(control), "curve")


low, high = campuses[0].city.bounds
anywhere = np.random.default_rng(0).uniform(low, high, (7, 3)).ravel()
ratio = campuses[0].integral(curve(anywhere)) / optima[0].cost
print(f"seven random waypoints: {ratio:.0f} times the optimum's cost")

# %% [markdown]
# The library's planner does the same. A curve that flies where it may not, or turns or climbs too much, gets a value
# above the cost of all that don't; the more it does so, the higher. So an optimiser sees a function $f$ of 21 numbers,
# and nothing else. To **evaluate** a point is to compute $f$ there.

# %% tags=["check"]
found = waypoint_swarm(campuses[0], start, goal, rng=0, budget=400, refinement=0.0)
assert np.isclose(campuses[0].integral(curve(found.info["control"][1:-1].ravel())), found.cost, rtol=1e-12)
assert ratio > 20

# %% [markdown]
# ## A swarm in a few lines
#
# $N$ particles fly through the space of all $\mathbf x$. In each iteration a particle moves by its velocity $\mathbf
# v$. Its own best point so far is $\mathbf p$, and the best of the swarm is $\mathbf g$ (PSO-BAS Eqs 13 to 16):
#
# $$ \mathbf v \leftarrow \omega \mathbf v + c_1 \mathbf r_1 (\mathbf p - \mathbf x)
#    + c_2 \mathbf r_2 (\mathbf g - \mathbf x), \qquad \mathbf x \leftarrow \mathbf x + \mathbf v. \tag{2} $$
#
# The numbers in $\mathbf r_1$ and $\mathbf r_2$ (no risks) are drawn uniformly from 0 to 1, for each particle and
# coordinate anew, and multiplied coordinate by coordinate. PSO-BAS Table 3 has $N = 20$, $c_1 = 1.5$, $c_2 = 2$ and the
# *inertia* $\omega = 1$. It has no limit of the velocity, and nothing on the border of the box that is searched. In our
# variant $\omega$ falls from 0.9 to 0.4 (Shi and Eberhart 1999), and a coordinate changes by at most a fifth of its
# range (our choice). In both, a particle stops at the border.


# %%
def swarm_by_hand(f, low, high, budget, seed, inertia=(0.9, 0.4), v_max=0.2, bounce=0.0):
    """Least value of f after each iteration of Eq. 2, for 20 particles."""
    rng = np.random.default_rng(seed)
    x = rng.uniform(low, high, (20, len(low)))
    v, p, value = np.zeros_like(x), x.copy(), f(x)
    least = [value.min()]
    for made in range(20, budget, 20):
        omega = inertia[0] + (inertia[1] - inertia[0]) * made / budget
        r1, r2 = rng.random((2, *x.shape))
        v = omega * v + 1.5 * r1 * (p - x) + 2.0 * r2 * (p[value.argmin()] - x)
        v = np.clip(v, -v_max * (high - low), v_max * (high - low))
        x = np.clip(x + v, low, high)
        v[(x == low) | (x == high)] *= bounce
        found = f(x)
        better = found < value
        p[better], value[better] = x[better], found[better]
        least.append(value.min())
    return np.array(least)


# %% [markdown]
# Three functions of six coordinates serve to try it. Each has its least value, 0, at one point: a bowl, a long bent
# valley, and a bowl full of holes.


# %%
def sphere(x):
    return (x**2).sum(axis=1)


def rosenbrock(x):
    return (100 * (x[:, 1:] - x[:, :-1] ** 2) ** 2 + (1 - x[:, :-1]) ** 2).sum(axis=1)


def rastrigin(x):
    return (10 + x**2 - 10 * np.cos(2 * np.pi * x)).sum(axis=1)


halves = {sphere: 5.0, rosenbrock: 2.0, rastrigin: 5.0}  # each coordinate from minus to plus so much
for f, half in halves.items():
    print(f.__name__, f"{swarm_by_hand(f, np.full(6, -half), np.full(6, half), 4000, seed=0)[-1]:.2g}")

# %% [markdown]
# The library's `pso` gives the same numbers in every iteration, with our settings and with the printed ones.
#
# > **Try it.** Take the falling inertia away: $\omega = 1$ in every iteration. Which of the functions suffers most?

# %% tags=["try-it"]
for f_now, half_now in halves.items():
    box_now = np.full(6, -half_now), np.full(6, half_now)
    print(f_now.__name__, f"{swarm_by_hand(f_now, *box_now, 4000, seed=0, inertia=(1.0, 1.0))[-1]:.2g}")

# %% tags=["check"]
constant = []
for (f, half), as_printed in product(halves.items(), (False, True)):
    library = pso(f, [(-half, half)] * 6, 4000, 10, as_printed=as_printed)
    box, how = (np.full(6, -half), np.full(6, half)), {"inertia": (1.0, 1.0)}
    by_hand = swarm_by_hand(f, *box, 4000, 10, **(how | {"v_max": np.inf} if as_printed else {}))
    assert np.array_equal(by_hand, library.history[library.iterations - 1])
    constant.append(f"{swarm_by_hand(f, *box, 4000, 0, **how)[-1]:.2g}")
assert constant[::2] == ["0.27", "9", "17"]

# %% [markdown]
# The bowl does: 0.27 is far from 0, while the falling inertia comes within $10^{-11}$.
#
# ## Does a particle come to rest?
#
# Suppose that nobody finds anything better for a while, and that $\mathbf p$ and $\mathbf g$ are the same point. We
# leave limit and border out, and measure one coordinate from that point. With the *pull* $\varphi = c_1 r_1 + c_2 r_2$,
# Eq. 2 says $v_{t+1} = \omega v_t - \varphi\, x_t$. Put $v_t = x_t - x_{t-1}$ into $x_{t+1} = x_t + v_{t+1}$:
#
# $$ x_{t+1} = q\, x_t - \omega\, x_{t-1}, \qquad q = 1 + \omega - \varphi. \tag{3} $$
#
# Here $\varphi$ is drawn anew in each step. A number from 0 to 1 has the mean $\tfrac12$ and the variance
# $\tfrac1{12}$. So $\varphi$ has the mean $\bar\varphi = (c_1 + c_2)/2$ and the variance $s^2 = (c_1^2 + c_2^2)/12$,
# and $q$ has the mean $\bar q = 1 + \omega - \bar\varphi$ and the same variance.
#
# **The mean.** The new $q$ doesn't depend on the $x$ before it. So $E[x_{t+1}] = \bar q\,E[x_t] -
# \omega\,E[x_{t-1}]$. A linear recursion like this dies out if both roots of $\lambda^2 - \bar q \lambda + \omega =
# 0$ are less than 1 in size. For a quadratic that means $|\omega| < 1$ and $|\bar q| < 1 + \omega$, which is a
# triangle:
#
# $$ |\omega| < 1, \qquad 0 < c_1 + c_2 < 4\,(1 + \omega). \tag{4} $$
#
# The printed $\omega = 1$ lies on its edge, whatever $c_1$ and $c_2$ are.
#
# > **Predict first.** At $\omega = 0.9$, where our swarm begins, the mean dies out. Does the particle come to rest?
#
# **The mean square.** A particle that jumps to the left and to the right, farther and farther, has a mean of 0, too.
# So we need $E[x^2]$. Square both sides of Eq. 3. Besides, multiply both sides of Eq. 3 (not squared) by $x_t$:
#
# $$ x_{t+1}^2 = q^2 x_t^2 - 2 \omega q\, x_t x_{t-1} + \omega^2 x_{t-1}^2, \qquad
#    x_{t+1} x_t = q\, x_t^2 - \omega\, x_t x_{t-1}. $$
#
# Take means, with $E[q^2] = \bar q^2 + s^2$:
#
# $$ \begin{pmatrix} E[x_{t+1}^2] \\ E[x_{t+1} x_t] \\ E[x_t^2] \end{pmatrix} = M
#    \begin{pmatrix} E[x_t^2] \\ E[x_t x_{t-1}] \\ E[x_{t-1}^2] \end{pmatrix}, \qquad
#    M = \begin{pmatrix} \bar q^2 + s^2 & -2\omega \bar q & \omega^2 \\ \bar q & -\omega & 0 \\ 1 & 0 & 0 \end{pmatrix}.
#    \tag{5} $$
#
# The largest eigenvalue of $M$ is the factor by which the mean square changes in a step, after the first few. Look at
# $\det(\lambda I - M)$. It is positive for large $\lambda$. If it is negative at $\lambda = 1$, it is 0 somewhere above:
# an eigenvalue is larger than 1, and the mean square grows. At $\lambda = 1$ it is $(1 + \omega)(1 - \omega^2 - s^2) -
# (1 - \omega)\,\bar q^2$. With $\bar q = 1 + \omega - \bar\varphi$ it is positive where
#
# $$ (1 + \omega)\, s^2 < (1 - \omega)\, \bar\varphi\, \bigl(2(1 + \omega) - \bar\varphi\bigr). \tag{6} $$
#
# Where the left-hand side is larger the mean square grows. (That it shrinks wherever Eq. 6 and $|\omega| < 1$ hold, the
# check cell below finds for 96 000 settings.) At $\omega = 1$ the right-hand side is 0, so the mean square grows for
# all $c_1$ and $c_2$. Now 20 000 particles walk, from a distance of 1 and from rest.


# %% tags=["nbval-check-output"]
def walk(inertia, c1=1.5, c2=2.0, steps=60, count=20_000):
    """Size of x after each step of Eq. 3, (steps + 1, count), and the root of E[x²] by Eq. 5."""
    rng, x = np.random.default_rng(0), np.ones((steps + 1, count))
    q_mean, variance = 1 + inertia - (c1 + c2) / 2, (c1**2 + c2**2) / 12
    matrix = [[q_mean**2 + variance, -2 * inertia * q_mean, inertia**2], [q_mean, -inertia, 0], [1, 0, 0]]
    squares = [np.ones(3)]
    for t in range(steps):
        q = 1 + inertia - [c1, c2] @ rng.random((2, count))
        x[t + 1] = q * x[t] - inertia * x[max(t - 1, 0)]
        squares.append(matrix @ squares[-1])
    return np.abs(x), np.sqrt(np.array(squares)[:, 0])


print("change per step:  mean  root mean square  median (steps 100 to 200)")
for inertia in (1.0, 0.9, 0.4):
    size, _ = walk(inertia, steps=200)
    mean, square = stability(inertia, 1.5, 2.0)  # the library's: sizes of the largest eigenvalues
    half = (np.median(size[200]) / np.median(size[100])) ** 0.01
    print(f"        ω = {inertia:<4g}{mean - 1:+10.1%} {np.sqrt(square) - 1:+17.1%} {half - 1:+7.1%}")

# %% tags=["check"]
for inertia in (1.0, 0.9, 0.4):
    root = walk(inertia)[1]
    assert np.isclose(np.sqrt(np.mean(walk(inertia, count=400_000, steps=8)[0][8] ** 2)), root[8], rtol=0.03)
w, c1, c2 = np.meshgrid(np.linspace(-0.99, 1.1, 60), np.linspace(0, 5, 40), np.linspace(0, 5, 40), indexing="ij")
mean, variance = (c1 + c2) / 2, (c1**2 + c2**2) / 12
inside = (np.abs(w) < 1) & ((1 + w) * variance < (1 - w) * mean * (2 * (1 + w) - mean))
spread = stability(w, c1, c2)[1]
assert np.array_equal(inside[np.abs(spread - 1) > 1e-6], (spread < 1)[np.abs(spread - 1) > 1e-6])
fine = np.linspace(0.4, 1.0, 6001)
assert round(fine[np.argmax(stability(fine, 1.5, 2.0)[1] >= 1)], 2) == 0.69
low, high = (np.median(walk(inertia, steps=200)[0][[100, 200]], axis=1) for inertia in (0.86, 0.88))
assert low[1] < low[0]
assert high[1] > high[0]

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 3, share="y", width=11.4, height=4.2)
for axes, inertia, says in zip(panels, (1.0, 0.9, 0.4), ("printed", "ours, at first", "ours, at last"), strict=True):
    x, root = walk(inertia)
    away = np.maximum(x, 1e-12)
    shown = {"median": np.median(away, axis=1), "root mean square (Eq. 5)": root, "one particle": away[:, 0]}
    middle = {"90 % of the particles": np.quantile(away, [0.05, 0.95], axis=1)}
    plot.lines(np.arange(61), shown, "step", "distance from the best point", bands=middle, log="y",
               y_range=(1e-10, 1e6), axes=axes, title=f"ω = {inertia:g} ({says})",
               colors={"90 % of the particles": plot.SKY, "median": plot.BLUE})  # fmt: skip
figure

# %% [markdown]
# *Distance from the best point, in units of the first.* The answer: no. At $\omega = 0.9$ the mean dies out, and still
# the root mean square grows by 9.5 % in a step, and the median by 1.4 %. At $\omega = 1$ the root mean square grows by
# 14 %, carried by a few particles that have flown very far. The median, the typical particle, grows by 6 %.

# %% tags=["figure"]
omegas, sums = np.linspace(-0.98, 0.98, 50), np.linspace(0.1, 8, 159)
variance = (1.5**2 + 2.0**2) / 3.5**2 / 12  # s² over (c₁ + c₂)²
square_ends = (1 - omegas**2) / (variance * (1 + omegas) + (1 - omegas) / 4)  # Eq. 6, solved for c₁ + c₂
pulls = np.tensordot([1.5 / 3.5, 2.0 / 3.5], np.random.default_rng(0).random((2, 121, 400)), 1)
median_ends = []
for w in omegas:
    now = before = np.ones((len(sums), 400))
    medians = []
    for pull in pulls:
        now, before = (1 + w - sums[:, None] * pull) * now - w * before, now
        medians.append(np.median(np.abs(now), axis=1) if len(medians) in (40, 120) else None)
    median_ends.append(sums[np.argmax(medians[120] >= medians[40])])
regions = {"mean (Eq. 4)": 4 * (1 + omegas), "median (400 particles)": median_ends, "mean square (Eq. 6)": square_ends}
points = {"printed: ω = 1": [(1, 3.5)], "ours: ω from 0.9 to 0.4": [(w, 3.5) for w in np.linspace(0.4, 0.9, 11)]}
plot.lines(omegas, regions, "inertia ω", "c₁ + c₂, with c₁ : c₂ = 1.5 : 2", points=points, y_range=(0, 8.2),
           x_range=(-1, 1.05), title="Below each line this size shrinks from step to step")  # fmt: skip

# %% [markdown]
# *Where mean, median and mean square shrink.* The printed swarm lies on the edge of Eq. 4. Ours begins between the
# lines. Its median shrinks below $\omega = 0.87$, its mean square below 0.69: from there on we say that it *settles*.
# (On the left the median shrinks where the mean grows. A few far particles can carry a mean, too.)
#
# > **Try it.** Clerc and Kennedy (2002) recommend $\omega = 0.7298$ and $c_1 = c_2 = 1.4962$, which never change. Does
# > this swarm settle, and how fast compared with ours at last?

# %% tags=["try-it"]
mean_now, square_now = stability(0.7298, 1.4962, 1.4962)
print(f"change per step: mean {mean_now - 1:+.1%}, root mean square {square_now**0.5 - 1:+.1%}")

# %% tags=["check"]
assert np.allclose(stability(omegas, square_ends * 1.5 / 3.5, square_ends * 2 / 3.5)[1], 1, atol=1e-6)
assert f"{stability(0.7298, 1.4962, 1.4962)[1] ** 0.5 - 1:+.1%}" == "-2.8%"

# %% [markdown]
# It settles, from the first iteration on, but slowly: by 2.8 % in a step, ours at last by 12 %.
#
# ## One beetle
#
# A beetle has an antenna on either side. It looks in a random direction, the unit vector $\mathbf b$, and smells at
# the tips of both antennae. Then it walks by the step $\delta$ to the side that smells better (PSO-BAS Eqs 17 to 21):
#
# $$ \mathbf x \leftarrow \mathbf x - \delta\, \mathbf b\, \operatorname{sign}\bigl(f(\mathbf x + d\,\mathbf b) -
#    f(\mathbf x - d\,\mathbf b)\bigr), \quad d \leftarrow \eta_d d, \quad \delta \leftarrow \eta_\delta \delta. \tag{7} $$
#
# Here $d$ is half the distance between the tips, and PSO-BAS Table 3 has $\eta_d = \eta_\delta = 0.95$. The first values
# $d_0$ and $\delta_0$ aren't given; we take $d_0 = \delta_0$. The beetle walks even if the place where it arrives is
# worse: on our functions about a quarter of its steps lead uphill. And it has a **reach**. All steps together are at
# most
#
# $$ \delta_0\,(1 + \eta_\delta + \eta_\delta^2 + \dots) = \frac{\delta_0}{1 - \eta_\delta} = 20\,\delta_0. \tag{8} $$
#
# A *greedy* beetle is ours. It goes to the better tip only if that is better than its place. Its antennae follow
# success (our choice): they grow by half after a gain and shrink by 13 % after none.

# %% tags=["figure"]
asked = []


def smelled(x):
    asked.append(x.copy())
    return sphere(x)


beetle = partial(bas, smelled, [(-5, 5)] * 2, 600, start=(-2.8, 2.6), antenna=0.01)  # 0.01 of the range: 0.1
beetle(5)
printed_walk = np.array([points[0] for points in asked if len(points) == 1])  # where it stood, not its tips
asked.clear()
beetle(6, greedy=True, decay=None)
points = np.concatenate(asked)
greedy_walk = points[np.unique(np.minimum.accumulate(sphere(points)), return_index=True)[1][::-1]]

# %% tags=["figure"]
side, around = np.linspace(-5, 5, 201), np.radians(np.arange(0, 361, 5))
reach = printed_walk[0] + 20 * 0.1 * np.stack([np.cos(around), np.sin(around)], axis=1)
ways = {
    "greedy beetle": greedy_walk,
    "printed beetle (Eq. 7)": printed_walk,
    "reach of the printed beetle (Eq. 8)": reach,
}
ends = {"start": printed_walk[0], "end of the printed beetle": printed_walk[-1], "least value": (0, 0)}
figure = plot.heat_map(side, side, side[:, None] ** 2 + side**2, "x₁", "x₂", "value of the bowl", equal=True,
                       paths=ways, points=ends, title="Two beetles in a bowl, with first steps of 0.1")  # fmt: skip
figure.axes[0].set(xlim=(-5, 1), ylim=(-1, 5))
figure

# %% tags=["check"]
assert np.linalg.norm(np.diff(printed_walk, axis=0), axis=1).sum() <= 20 * 0.1 + 1e-9
assert np.linalg.norm(printed_walk[-1]) > 1.5 > 0.01 > np.linalg.norm(greedy_walk[-1])
for f, half in halves.items():
    asked.clear()
    bas(lambda x, f=f: (asked.append(f(x)), asked[-1])[1], [(-half, half)] * 6, 600, 1, as_printed=True)
    stood = np.array([values[0] for values in asked if len(values) == 1])
    assert 0.2 < np.mean(np.diff(stood) > 0) < 0.3

# %% [markdown]
# *A first step that is too short, chosen to show the reach.* The least value is more than $20\,\delta_0 = 2$ away, so
# the printed beetle can't get there. Below, $\delta_0$ is 0.3 of the range (our choice): then 20 steps are six ranges,
# and the reach is no limit.
#
# ## Swarm and beetles together
#
# PSO-BAS section 4.3 says in step 3: "Update individual and global optimality through BAS." What is probed isn't said.
# We take each particle's *best* point. So one iteration is:
#
# 1. A particle probes both tips around its best point $\mathbf p$, at $\mathbf p + d\,\mathbf b$ and $\mathbf p -
#    d\,\mathbf b$: two evaluations.
# 2. It looks where Eq. 7 leads from $\mathbf p$: one evaluation. If $f$ is less there, that is the new $\mathbf p$.
# 3. After all particles have done so, $\mathbf g$ is the best $\mathbf p$, and all fly by Eq. 2: one evaluation each.
# 4. $d$ and $\delta$ shrink.
#
# The beetle's dimension $m$ is 3 in Table 3, so we read: $\mathbf b$ moves three coordinates at a time, those of *one*
# waypoint. The printed particle makes four evaluations per iteration. Ours makes seven, as it probes three times,
# greedily, and one of PSO makes one. So a fair comparison is at equal numbers of *evaluations*, not iterations: 4 000
# here, with 15 seeds. In a swarm $d_0$ is 0.15 of the range (our choice).
#
# > **Predict first.** *Random search* draws 4 000 points in the box and keeps the best. On which of the three
# > functions does the printed swarm, with $\omega = 1$ and no limit of its steps, beat it?


# %%
def random_search(f, box, budget, seed):
    low, high = np.array(box).T
    return f(np.random.default_rng([seed, 1]).uniform(low, high, (budget, len(low))))


methods = {
    "random search": random_search,
    "PSO, printed": partial(pso, as_printed=True),
    "PSO, ours": pso,
    "beetle, printed": partial(bas, as_printed=True),
    "beetle, greedy": partial(bas, greedy=True, decay=None),
    "PSO-BAS, printed": partial(pso_bas, as_printed=True),
    "PSO-BAS, ours": pso_bas,
}
least = {}  # found with each seed
for (name, method), (f, half) in product(methods.items(), halves.items()):
    runs = [method(f, [(-half, half)] * 6, 4000, seed) for seed in range(15)]
    least[name, f.__name__] = np.array([np.min(getattr(run, "history", run)) for run in runs])

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 3, share="y", width=11.4, height=4.2)
for axes, f in zip(panels, halves, strict=True):
    shown = {}
    for name in methods:
        shown[name] = tuple(np.maximum(np.quantile(least[name, f.__name__], [0.5, 0.25, 0.75]), 1e-18))
    plot.intervals({"median, and middle half of 15 seeds": shown}, "least value", level="50 %", log=True,
                   axes=axes, title=f.__name__)  # fmt: skip
    axes.set_xlabel("least value found, logarithmic")
panels[0].set_xticks([1e-16, 1e-12, 1e-8, 1e-4, 1])
figure

# %% [markdown]
# *Least values that 15 seeds find: median, and the middle half.* To compare two methods we count the seeds with which
# one finds less than the other. The interval of that share is exact (binomial). If it contains one half, no difference
# is shown.


# %% tags=["nbval-check-output"]
def ahead(one, other):
    """In how many runs one value is below the other, and the exact 95 % interval of the share."""
    count = int((one < other).sum())
    low, high = share_interval(count, len(one))
    return f"{count:2d} of {len(one)} [{low:.0%}, {high:.0%}]"


pairs = [
    ("PSO, printed", "random search"),
    ("PSO-BAS, printed", "PSO, printed"),
    ("beetle, greedy", "PSO, ours"),
    ("PSO-BAS, ours", "PSO, ours"),
]
print(f"{'one less than the other':<32}", *(f"{f.__name__:<23}" for f in halves))
for one, other in pairs:
    counts = [ahead(least[one, f.__name__], least[other, f.__name__]) for f in halves]
    print(f"{one + ' / ' + other:<32}", *(f"{count:<23}" for count in counts))

# %% tags=["check"]
middle = {key: np.median(values) for key, values in least.items()}
assert max(middle[f"beetle, {how}", "sphere"] for how in ("printed", "greedy")) < 1e-16
assert middle["beetle, greedy", "rosenbrock"] < min(
    middle[name, "rosenbrock"] for name in methods if name != "beetle, greedy"
)
assert (
    min(middle[f"beetle, {how}", "rastrigin"] for how in ("printed", "greedy")) > 4 * middle["PSO, ours", "rastrigin"]
)
for f, half in halves.items():  # with another border the printed swarm isn't better than random search, either
    box = np.full(6, -half), np.full(6, half)
    for bounce in (1.0, -1.0):
        runs = [swarm_by_hand(f, *box, 4000, seed, (1.0, 1.0), np.inf, bounce)[-1] for seed in range(15)]
        count = int((np.array(runs) < least["random search", f.__name__]).sum())
        assert share_interval(count, 15)[0] < 0.5, (f, bounce, count)

# %% [markdown]
# - **Printed PSO** isn't shown to beat random search on any of them. Nor is it if particles keep their velocity at the
#   border, or are reflected.
# - **A beetle** is a local search. It finds the bottom of the bowl (what is left below $10^{-16}$ only says how short
#   the antennae get), and is caught in one of the holes. In the valley the greedy one is the best of all.
# - **Antennae** rescue the swarm that can't settle. For the one that settles no gain is shown in the valley and among
#   the holes, and in the bowl it falls far behind, as it flies a seventh as often.
#
# ## Back to the route
#
# Seven random waypoints make a long, tangled curve. So the swarm begins with *arcs*: straight lines from start to goal
# that are bent sideways by half waves of random height, and upwards by one. Of 200 arcs the best 20 are the first
# places. All of that is our choice; "anywhere" below means: without it.
#
# Three planners get 4 000 evaluations, once on each of the 12 campuses. PSO-BAS gives no settings of its ants, so they
# have those of RISK-ACO, the paper of chapter 10. The third rival, PSO-ACO, is only named in the text that we have. We
# leave it out.

# %%
plain = partial(waypoint_swarm, refinement=0.0)  # a last step that comes later, for all alike
as_printed = partial(plain, as_printed=True)
printed = {
    "PSO-BAS": as_printed,
    "PSO": partial(as_printed, optimizer="pso"),
    "ACO": partial(ant_colony, as_printed=True),
}
run = partial(compare_planners, start=start, goal=goal, seeds=[0], budget=4000, jobs=1, progress=False)
paper = run(printed, maps=campuses)

# %% tags=["figure"]
COLORS = {"PSO-BAS": plot.GREEN, "PSO": plot.PINK, "ACO": plot.ORANGE, "exact, refined": plot.BLUE,
          "exact optimum": plot.BLACK}  # fmt: skip
figure = plot.convergence(paper, colors=COLORS)
figure.axes[0].set_title("As printed: gap over evaluations, 12 campuses")
figure

# %% [markdown]
# *Median gap and quartiles over the evaluations made.* PSO-BAS goes on to improve, the two others hardly move.


# %% tags=["nbval-check-output"]
def show(comparison, evaluation=-1):
    """Median gaps with 95 % intervals, and on how many campuses PSO-BAS is ahead."""
    found = comparison.histories[:, :, 0, evaluation]
    for name, gaps in zip(comparison.planners, found, strict=True):
        low, high = over_maps(np.median, 100 * gaps[:, None])
        count = "" if name == "PSO-BAS" else f"PSO-BAS ahead on {ahead(found[0], gaps)}"
        print(f"{name:<8} median gap {100 * np.median(gaps):5.1f} % [{low:.1f}, {high:.1f}]  {count}")


show(paper)
print(f"best of the arcs: median gap {100 * np.median(paper.histories[1, :, 0, 199]):.1f} %")
for name, ends in zip(paper.planners, paper.converged()[1], strict=True):
    print(f"{name}: at its end after {np.median(ends):.0f} iterations")
long_run = run({"PSO-BAS": as_printed}, maps=campuses[:6], budget=16_140)  # arcs, and 200 iterations
print(f"PSO-BAS with {len(long_run.iterations[0])} iterations: at its end after", end=" ")
print(*np.sort(long_run.converged()[1].ravel()), "(six campuses)")

# %% [markdown]
# (The interval of a median is a bootstrap over the campuses. "At its end" means within 1 % of the last cost.)
#
# - **Less risk than PSO and ACO:** so we find it, on all 12 campuses. But printed PSO hardly improves on our best arc.
#   And the ants have another paper's settings.
# - **Complete after 55 iterations:** Table 3 has 200. On six campuses PSO-BAS is at its end after 49 to 81. So 55 is
#   possible.
# - **Faster than the others:** PSO and ACO stop after two iterations, with larger gaps. And an iteration of PSO-BAS
#   makes 80 evaluations, one of PSO 20, one of ACO 10.
#
# ## The same care for all
#
# Now each planner gets our settings (for PSO-BAS on routes: five probes, $\eta_d = 0.98$), and the same last step. In
# this *refinement* the route becomes a curve with a waypoint every two voxels, and a greedy beetle moves them one at a
# time. It takes 40 % of the 4 000 evaluations. Without it, free curves would be compared with ants that are bound to
# 26 moves.
#
# > **Predict first.** As printed, PSO-BAS was ahead of the ants on all campuses. On how many is it now?

# %% tags=["nbval-check-output"]
ours = {"PSO-BAS": plain, "PSO": partial(plain, optimizer="pso"), "ACO": ant_colony}
tuned = run(ours, maps=campuses, refinement=0.4)
for evaluation, says in ((2399, "before the refinement:"), (3999, "refined:")):
    print(says)
    show(tuned, evaluation)

# %% [markdown]
# Only on four, and the interval contains one half: neither is shown to be better. PSO-BAS is ahead of PSO on 10 of 12
# campuses, but before the refinement it was behind on ten. Both intervals only just exclude one half, and we don't know
# why the order turns. So it isn't shown that antennae make the swarm's search better. And if it begins anywhere?

# %% tags=["nbval-check-output"]
elsewhere = {"PSO-BAS": partial(plain, arcs=0), "PSO": partial(plain, optimizer="pso", arcs=0)}
begun = run(elsewhere, maps=campuses[:6], refinement=0.4)
for name, gaps, arcs in zip(elsewhere, begun.gaps[..., 0], tuned.gaps[..., 0], strict=False):
    print(f"{name} begun anywhere, refined: median gap {100 * np.median(gaps):.0f} %,", end=" ")
    print(f"arcs are better on {ahead(arcs[:6], gaps)} campuses")

# %% [markdown]
# Both are far worse: where a swarm begins matters more than which swarm it is.
#
# ## Exact first, then refine
#
# A swarm has to find a good valley of $f$ and the way along its bottom at once. An exact search on the grid finds a
# valley, but it can't follow the bottom at any angle. So refine the exact optimum, with the same 1 600 evaluations.

# %% tags=["nbval-check-output"]
refined = [refine(exact, campus, rng=0, budget=1600) for campus, exact in zip(campuses, optima, strict=True)]
gains = np.array([optimality_gap(route, exact) for route, exact in zip(refined, optima, strict=True)])
low, high = over_maps(np.median, 100 * gains[:, None])
print(f"exact, refined: median gap {100 * np.median(gains):.1f} % [{low:.1f}, {high:.1f}]")
for name, gaps in zip(ours, tuned.gaps[..., 0], strict=True):
    print(f"{name} has the smaller gap on {(gaps < gains).sum()} of 12 campuses")

# %% tags=["figure"]
rows = {name: 100 * gaps for name, gaps in zip(ours, tuned.gaps[..., 0], strict=True)} | {"exact, refined": 100 * gains}
plot.runs({"median of 12 campuses": rows}, "gap to the exact optimum on the grid [%]",
          places={"optimum on the grid": 0.0}, title="Our settings, all refined")  # fmt: skip

# %% [markdown]
# *A stroke for each campus.* The refined optimum is below the grid's on all campuses, and the exact search takes
# less than a tenth of the time of any of the others.
#
# Why is PSO-BAS up to 15 % worse than the grid's optimum? We take its worst campus, and move each point of its route in
# a straight line to the matching point of the refined optimum.


# %%
def evenly(route):
    """81 points at equal distances along a route."""
    at = np.linspace(0, route.length, 81)
    return np.stack([np.interp(at, route.distance, axis) for axis in route.points.T], axis=1)


worst = int(np.argmax(tuned.gaps[0, :, 0]))
swarmed = refine(plain(campuses[worst], start, goal, rng=0, budget=2400), campuses[worst], rng=0, budget=1600)
first, last, shares = evenly(swarmed), evenly(refined[worst]), np.linspace(0, 1, 41)
between = [campuses[worst].integral(Route((1 - t) * first + t * last, "between")) for t in shares]
print(f"greatest cost on the way: {max(between) / optima[worst].cost:.0f} times the optimum's")

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 3, width=12.6, height=4.4)
pair = {"PSO-BAS": swarmed, "exact, refined": refined[worst]}
heights = {name: np.interp(np.linspace(0, 1, 81), one.distance / one.length, one.points[:, 2])
           for name, one in pair.items()}  # fmt: skip
plot.lines(np.linspace(0, 1, 81), heights, "share of the way", "height [m]", colors=COLORS, axes=panels[0],
           y_range=(0, None), title="The two routes, from the side")  # fmt: skip
plot.lines(shares, {"route in between": np.array(between) / optima[worst].cost}, "from PSO-BAS (0) to exact, refined (1)",
           "cost over the optimum's", log="y", axes=panels[1], colors={"route in between": plot.BLACK},
           title="A ridge between two valleys")  # fmt: skip
plot.value_map(campuses[worst].city, plot.ground_risk(campuses[worst]), "risk r just above the ground [1/h]",
               norm=plot.risk_norm(campuses[worst]), paths={name: one.points[:, :2] for name, one in pair.items()},
               points={"start": start[:2], "goal": goal[:2]}, colors=COLORS, axes=panels[2],
               title="From above")  # fmt: skip
figure

# %% [markdown]
# *The campus on which PSO-BAS is worst.* On the straight way from one route to the other the cost rises to 16 times the
# optimum's. So, at least on this way, a high ridge lies between two valleys of $f$. The refinement moves a waypoint only
# if that gains, so it stays in its valley.

# %% tags=["check"]
assert f"{100 * tuned.gaps[0].max():.0f} {max(between) / optima[worst].cost:.0f}" == "15 16"
assert (begun.gaps > tuned.gaps[:2, :6]).all()
assert gains.max() < 0
assert np.median([exact.info["elapsed"] for exact in optima]) < 0.1 * np.median(tuned.elapsed, axis=(1, 2)).min()
ends = np.sort(long_run.converged()[1].ravel())
assert ends[0] < 55 < ends[-1]

# %% [markdown]
# ## Remember
#
# - A route with $K$ waypoints is a point in $3K$ dimensions, and a swarm can minimise any function of it, also one that
#   doesn't add up along the way.
# - A mean that dies out isn't enough: the mean square needs Eq. 6. With $\omega = 1$ it grows, whatever $c_1$ and $c_2$.
# - A few particles can carry a mean square. Say what the typical one does, too.
# - A printed beetle gets no farther than $20\,\delta_0$.
# - Where a swarm begins mattered more than which swarm it was.
# - Compare at equal evaluations and with equal refinement. The exact optimum, refined, was the best on all campuses.
#
# ## What the paper says, what we find
#
# | PSO-BAS | says | we find |
# |---|---|---|
# | Table 3: $\omega$ | 1 | the mean square grows for all $c_1, c_2$; not shown to beat random search on three functions |
# | Eqs 18, 20, 21 | $d$: distance between the antennae; $\delta_0$ not given | half of it; reach $20\,\delta_0$ |
# | 4.3, step 3 | update through BAS | antennae at the best points rescue $\omega = 1$; for a swarm that settles no gain shown |
# | Figs 9, 10 | less risk than PSO, ACO, PSO-ACO | as printed: on 12 of 12 campuses [74 %, 100 %] less than PSO and ACO, from our start; PSO-ACO not tested |
# | | | our settings, all refined: less than PSO on 10 of 12 [52 %, 98 %], than ACO on 4 of 12 [10 %, 65 %] |
# | Fig. 10 | complete after 55 iterations, faster than the others | after 49 to 81 of 200: **possible**; PSO and ACO stop earlier, with larger gaps |
# | (not said) | gap (median) | as printed, not refined 12.5 %; ours, refined 2.5 %; exact, refined −4.4 % |
#
# (The two figures aren't in the text that we have. Table 4 belongs to chapter 09.)
#
# ## Read on
#
# - J. Kennedy, R. Eberhart, "Particle swarm optimization", *Proceedings of ICNN'95* (1995) 1942–1948,
#   [doi:10.1109/ICNN.1995.488968](https://doi.org/10.1109/ICNN.1995.488968): the first swarm, without $\omega$.
# - Y. Shi, R. Eberhart, "Empirical study of particle swarm optimization", *Proceedings of CEC 1999*, 1945–1950,
#   [doi:10.1109/CEC.1999.785511](https://doi.org/10.1109/CEC.1999.785511): $\omega$ from 0.9 to 0.4.
# - M. Clerc, J. Kennedy, "The particle swarm: explosion, stability, and convergence in a multidimensional complex
#   space", *IEEE Transactions on Evolutionary Computation* 6 (2002) 58–73,
#   [doi:10.1109/4235.985692](https://doi.org/10.1109/4235.985692): when the mean comes to rest.
# - R. Poli, "Mean and variance of the sampling distribution of particle swarm optimizers during stagnation", *IEEE
#   Transactions on Evolutionary Computation* 13 (2009),
#   [doi:10.1109/TEVC.2008.2011744](https://doi.org/10.1109/TEVC.2008.2011744): the mean square, and higher moments.
# - X. Jiang, S. Li, "BAS: beetle antennae search algorithm for optimization problems" (2017),
#   [arXiv:1710.10724](https://arxiv.org/abs/1710.10724): the beetle alone.
#
# ## Your turn
#
# Six exercises: what a mean says, steps of a beetle and of a swarm, whether one planner is better than another, an
# optimiser that finds the errors of its cost, and a swarm of your own:
# [exercises/11_particle_swarm_and_beetles_exercises.ipynb](exercises/11_particle_swarm_and_beetles_exercises.ipynb).
#
# Before: [10 Ant colony](10_ant_colony.ipynb). Next: [12 B-splines](12_bsplines_and_feasibility.ipynb).
