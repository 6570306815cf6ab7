# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 02 The Pauta criterion: how far from a wall is far enough?
#
# A drone flies past a wall, and gusts push it to the side. How far from the wall should its route be? REPARE, the paper
# on routes in wind and rain from chapter [00](00_start_here.ipynb), answers with the 3σ rule, which it calls the *Pauta
# criterion*: keep three standard deviations and half the body, because 99.7 % of all offsets lie within. That is true on
# one axis at one moment. A flight has more axes and many moments. At the end we compute a distance for all the time that
# a flight spends beside walls, and say what it promises.
#
# | | |
# |---|---|
# | **You will be able to** | compute how much of a Gaussian offset lies within $k\sigma$ in one, two and three dimensions; remove gross errors from samples, and say when that fails; derive how often a random signal crosses a level; choose $k$ for the question that you have |
# | **You need** | mean, standard deviation, the normal distribution and integrals; chapter [01](01_wind_and_rain.ipynb) for where gusts come from |
# | **Time** | 75 minutes to read, 20 seconds to run |
# | **Paper** | REPARE, sections 2.2.2, 2.3.1 and 3.4, Eqs 6, 7 and 17 ([doi:10.3390/s22062151](https://doi.org/10.3390/s22062151)) |
#
# "Eq. 3" is an equation of this chapter, "REPARE Eq. 6" is one of the paper's. We have the paper's text, but not its
# pictures.

# %%
import math

import numpy as np
from scipy import linalg, optimize, stats

from uavlab import offsets, plot
from uavlab.flight import Autopilot
from uavlab.offsets import JointOffset, OffsetModel, SkewedOffset

BLACK, BLUE, GREEN, ORANGE, PINK = plot.BLACK, plot.BLUE, plot.GREEN, plot.ORANGE, plot.PINK

# %% [markdown]
# ## One axis: what 3σ promises
#
# Let $x$ be the *offset*: how far [m] a gust has pushed the UAV to the right of its route; to the left, $x$ is negative.
# REPARE takes the force of the gusts to be approximately Gaussian, and writes the Gaussian density for the offset
# (REPARE Eq. 6), with the mean $\mu$ and the standard deviation $\sigma$:
#
# $$ f(x) = \frac{1}{\sqrt{2\pi}\,\sigma} \exp\left(-\frac{(x-\mu)^2}{2\sigma^2}\right). \tag{1} $$
#
# What share of all offsets lies within $k$ standard deviations of the mean? We integrate, with the substitution
# $t = (x-\mu)/(\sqrt2\,\sigma)$, so that $dx = \sqrt2\,\sigma\,dt$:
#
# $$ P_1(k) = \int_{\mu-k\sigma}^{\mu+k\sigma} f(x)\,dx = \frac{2}{\sqrt\pi}\int_0^{k/\sqrt2} e^{-t^2}\,dt
#    = \operatorname{erf}\frac{k}{\sqrt2}. \tag{2} $$
#
# Neither $\mu$ nor $\sigma$ is left in the result, so the share is the same for every *Gaussian* offset. The library's
# `offsets.coverage` computes it:

# %%
for k in (1, 2, 3, 4):
    print(f"within {k}σ on one axis: {offsets.coverage(k, dimensions=1):8.4%}")

# %% tags=["check"]
assert math.isclose(offsets.coverage(3, 1), math.erf(3 / math.sqrt(2)), rel_tol=1e-12)
assert f"{offsets.PAUTA_COVERAGE:.4%}" == "99.7300%"

# %% tags=["figure"]
x, k = np.linspace(-4.5, 4.5, 901), np.linspace(0, 4.5, 451)
density, within = OffsetModel(mean=0.0, sigma=1.0).density(x), "within 3σ: 99.73 %"
bands = {within: (0, np.where(np.abs(x) <= 3, density, np.nan))}
colors = {"density": BLACK, within: GREEN, "left and right together": BLUE, "at 3σ": BLACK}
figure, (left, right) = plot.new_panels(1, 2, width=9.0, height=3.9)
plot.lines(x, {"density": density}, "offset x − μ [σ]", "density f(x) [1/σ]", bands=bands, colors=colors, axes=left,
           title="The Pauta criterion on one axis")  # fmt: skip
plot.lines(k, {"left and right together": 100 * (1 - offsets.coverage(k, 1))}, "k", "offsets beyond kσ [%]", log="y",
           y_range=(0.001, 110), points={"at 3σ": [(3, 0.27)]}, notes={"0.27 %": (3, 0.27)},
           colors=colors, title="What kσ leaves out", axes=right)  # fmt: skip
figure

# %% [markdown]
# *Left: the density of the offset. Right: the share of offsets farther out than $k\sigma$.* 3σ leaves out 0.27 %.
#
# ## A wall stands on one side
#
# The criterion comes from measurement, where a value that is too high is as bad as one that is too low.
#
# > **Predict first.** A UAV flies past a single wall. How large is the chance that its offset *towards the wall* exceeds
# > 3σ, at a moment that we pick at random? 0.27 %, less, or more?
#
# Half of 0.27 %, because an offset away from the wall does no harm. With the distribution function $\Phi$ of the standard
# normal distribution it is $1 - \Phi(3)$:

# %%
TOWARDS_WALL = stats.norm.sf(3)  # "survival function", 1 − Φ(3)
print(f"{TOWARDS_WALL:.3%}, one in {1 / TOWARDS_WALL:.0f}")

# %% [markdown]
# So **0.135 % is the share for one wall** in this chapter, and 0.27 % that for all directions together.
#
# The route is that of the UAV's centre, and the body sticks out by half its diameter $D_\text{uav}$. Let $\xi$ be the
# largest offset that must not lead to a touch. Then the distance to keep is (REPARE Eq. 7)
#
# $$ D_\text{min} \ge \xi + \tfrac12 D_\text{uav}, \qquad \xi = k\,\sigma, \tag{3} $$
#
# and $k = 3$ in the paper. Our examples have a body of 1 m and $\sigma = 1$ m (our choice). Then $k = 3$ gives
# $D_\text{min}$ = 3.5 m, the smallest in the paper's Table 4.

# %% tags=["check"]
sigmas = (np.array([3.5, 4.5, 5.5]) - 0.5) / 3
assert np.allclose(offsets.minimum_safe_distance(3 * sigmas, 1.0), [3.5, 4.5, 5.5])
assert [f"{sigma:.2f}" for sigma in sigmas] == ["1.00", "1.33", "1.67"]
assert np.allclose([OffsetModel(0.0, sigma).beyond(3 * sigma) for sigma in sigmas], TOWARDS_WALL)

# %% [markdown]
# ## What the rule was made for: gross errors
#
# Some samples may be wrong, because the position sensor jumped or somebody touched the UAV. The Pauta criterion removes
# such *gross errors*: whatever is farther than $3\sigma$ from the mean. But a gross error widens the very $\sigma$ that
# it is judged by. So we remove, compute mean and $\sigma$ anew, and go on until a round removes nothing:


# %%
def without_gross_errors(samples):
    """Samples without gross errors; and mean, σ and how many went, for each round that removed some."""
    left, rounds = samples, []
    while True:
        mean, sigma = left.mean(), left.std(ddof=1)  # divided by N − 1
        near = np.abs(left - mean) <= 3 * sigma
        if near.all():
            return left, rounds
        rounds.append((mean, sigma, np.sum(~near)))
        left = left[near]


# %% [markdown]
# We try it on invented data, 200 good offsets and eight gross errors of very different sizes. The library's
# `pauta_filter` does the same.

# %%
errors = np.array([4.5, -5.0, 6.0, 9.0, -14.0, 25.0, 40.0, -70.0])
samples = np.concatenate([OffsetModel(0.2, 0.8).sample(200, rng=2), errors])
left, rounds = without_gross_errors(samples)
for number, (_, sigma, removed) in enumerate(rounds, start=1):
    print(f"round {number}: σ = {sigma:.2f} m, {removed} removed")
print(f"then none: {len(left)} are left, σ = {left.std(ddof=1):.2f} m")

# %% tags=["check"]
found = offsets.pauta_filter(samples)
assert found.rounds == len(rounds) == 3
assert np.array_equal(samples[found.kept], left)
assert not found.kept[200:].any()
assert [removed for _, _, removed in rounds] == [3, 4, 1]
assert sorted(np.abs(errors).argsort()[-3:]) == [5, 6, 7]
assert round(found.sigma, 2) == 0.77

# %% tags=["figure"]
history = [*rounds, (left.mean(), left.std(ddof=1), 0)]
beside = np.append(np.random.default_rng(1).uniform(-0.25, 0.25, 200), np.linspace(-0.25, 0.25, 8))
parts, remaining = {"gross error": [], "good sample": []}, np.ones(len(samples), dtype=bool)
for number, (mean, sigma, _) in enumerate(history, start=1):
    dots = np.column_stack([number + beside, np.abs(samples - mean)])
    parts["gross error"] += list(dots[200:][remaining[200:]])
    parts["good sample"] += list(dots[:200][remaining[:200]])
    remaining &= dots[:, 1] <= 3 * sigma
figure, axes = plot.new_figure(7.2, 3.9)
ends = [(number + side, 3 * sigma) for number, (_, sigma, _) in enumerate(history, 1) for side in (-0.35, 0.35, np.nan)]
axes.plot(*np.transpose(ends), color=BLACK, linewidth=2, label="3σ of this round: what lies above is removed")
plot.points(parts, "round", "distance from the mean [m]", log="y", axes=axes, y_range=(0.01, 150),
            title="Each round uncovers errors that the last one hid", colors={"gross error": ORANGE, "good sample": BLUE})  # fmt: skip
axes.set_xticks(range(1, len(history) + 1))
figure

# %% [markdown]
# *The samples at the beginning of each round (spread sideways only to be seen).* In round 1 only the errors of 25, 40 and
# −70 m lie above 3σ. They make $\sigma$ so large that the other five lie below. Round 2 misses the 4.5 m. In a fourth round
# nothing lies above the line, and we stop.
#
# Two warnings. Of 1000 good samples, 3σ removes 2.7, too (Eq. 2), and these are the strongest gusts: never filter the data
# that safety is computed from without looking at what goes. And **with few samples the filter can't find anything.** Put
# one sample at $a$ and $N-1$ at 0. The mean is $\bar x = a/N$. The squared deviations add up to $(a - a/N)^2 + (N-1)(a/N)^2 =
# a^2 (N-1)/N$, so the estimate of $\sigma$ is $\hat\sigma = a/\sqrt N$, and
#
# $$ \frac{a - \bar x}{\hat\sigma} = \frac{a\,(N-1)/N}{a/\sqrt N} = \frac{N-1}{\sqrt N}. \tag{4} $$
#
# No other values take a sample more $\hat\sigma$ from the mean (Shiffler, see "Read on"). For $N = 10$ it is 2.85: among
# ten samples even 1000 m is no gross error. For $N = 11$ it is 3.02. We also put one error among simulated Gaussian
# samples. With $N = 11$, an error of 20σ is found in 7 % of the cases; with $N = 20$, one of 5σ in 83 %.

# %% tags=["check"]
ratios = [(count - 1) / math.sqrt(count) for count in (10, 11)]
assert [round(ratio, 2) for ratio in ratios] == [2.85, 3.02]
for count, ratio in zip((10, 11), ratios, strict=True):
    spike = np.append(np.zeros(count - 1), 1000.0)
    assert math.isclose((spike[-1] - spike.mean()) / spike.std(ddof=1), ratio)
try:
    refused = repr(offsets.pauta_filter(np.append(np.zeros(9), 1000.0)))
except ValueError as error:
    refused = str(error)
assert "at least 11" in refused
for count, error, wanted in ((11, 20.0, 0.07), (20, 5.0, 0.83)):
    trials = np.random.default_rng(1).standard_normal((20_000, count))
    trials[:, 0] = error
    shares = np.mean(trials[:, 0] - trials.mean(axis=1) > 3 * trials.std(axis=1, ddof=1))
    assert round(shares, 2) == wanted

# %% [markdown]
# ## Two axes and three
#
# > **Predict first.** A UAV can be pushed to the side *and* up or down. Let both offsets have the same $\sigma$, the mean 0,
# > and be independent. What share lies within a *circle* of radius $3\sigma$ around the route? More than 99.73 %, the
# > same, or less?
#
# Let $s$ be the distance from the route, in units of $\sigma$. The joint density is $e^{-s^2/2}/2\pi$. The thin ring
# between $s$ and $s + ds$ has the area $2\pi s\,ds$. So
#
# $$ P_2(k) = \int_0^k \frac{e^{-s^2/2}}{2\pi}\; 2\pi s\,ds = \Big[-e^{-s^2/2}\Big]_0^k = 1 - e^{-k^2/2}. \tag{5} $$
#
# For $k = 3$ this is 98.89 %. **Less.** To leave the circle, an offset needs to be large on one axis *or* moderately
# large on both. On $d$ axes, the sum $\chi^2_d$ of $d$ squared standard normal variables follows the *chi-square law with
# $d$ degrees of freedom*, which SciPy knows. The share within $k\sigma$, and the radius that holds a share $P$, are
#
# $$ P_d(k) = \text{chance of } \chi^2_d \le k^2, \qquad k_d(P) = \sqrt{\text{quantile of } \chi^2_d \text{ at } P}. \tag{6} $$
#
# These are `offsets.coverage` and `offsets.pauta_radius`. We also draw a million offsets and count:

# %%
pushes = np.random.default_rng(2).standard_normal((1_000_000, 3))  # to the side, up, along the route [σ]
for d in (1, 2, 3):
    counted = np.mean(np.linalg.norm(pushes[:, :d], axis=1) <= 3)
    print(
        f"{d} D: 3σ holds {offsets.coverage(3, d):.2%} (counted {counted:.2%}); "
        f"99.73 % needs {offsets.pauta_radius(d):.2f}σ"
    )

# %% tags=["check"]
for d, left_out in zip((1, 2, 3), ("0.27%", "1.11%", "2.93%"), strict=True):
    exact = offsets.coverage(3, d)
    assert abs(np.mean(np.linalg.norm(pushes[:, :d], axis=1) <= 3) - exact) < 4 * math.sqrt(exact * (1 - exact) / 1e6)
    assert math.isclose(offsets.pauta_radius(d), math.sqrt(stats.chi2.ppf(offsets.PAUTA_COVERAGE, d)), abs_tol=1e-9)
    assert f"{1 - exact:.2%}" == left_out
assert math.isclose(offsets.coverage(3, 2), 1 - math.exp(-4.5))
assert [round(offsets.pauta_radius(d), 2) for d in (2, 3)] == [3.44, 3.76]

# %% tags=["figure"]
k, dimensions, names = np.linspace(0, 5, 501), (1, 2, 3), ("offset on one axis", "in a plane", "in three dimensions")
beyond = {name: 100 * (1 - offsets.coverage(k, d)) for d, name in zip(dimensions, names, strict=True)}
outside = [(3, 100 * (1 - offsets.coverage(3, d))) for d in dimensions[1:]]
radii = [(offsets.pauta_radius(d), 0.27) for d in dimensions]
points = {"what 3σ leaves out": outside, "radius that leaves out 0.27 %": radii}
notes = {f"{at[1]:.2f} %": at for at in outside} | {"3.44": radii[1], "3.76": radii[2]}
plot.lines(k, beyond, "radius k [σ]", "offsets beyond the radius [%]", points=points, notes=notes, limits={"0.27 %": 0.27},
           log="y", y_range=(0.01, 110), title="The same radius leaves out more in more dimensions",
           colors=dict(zip(names, (BLUE, BLACK, ORANGE), strict=True)) | dict.fromkeys(points, GREEN))  # fmt: skip

# %% [markdown]
# *The share of offsets beyond a radius of $k\sigma$.* Up from 3σ on the blue curve: the same radius leaves out 1.11 % in
# the plane, and 2.93 % in three dimensions, eleven times as much. To the right: 0.27 % needs 3.44σ and 3.76σ.

# %% [markdown]
# ## REPARE's Fig. 18: a density, and a circle
#
# REPARE section 3.4 gives the joint distribution of two offsets, one perpendicular to the ground and one parallel to it
# (REPARE Eq. 17). With the standardised offsets $z_1 = (x - \mu_1)/\sigma_1$, $z_2 = (y - \mu_2)/\sigma_2$ and their
# correlation $\rho_{12}$ (the paper's $\rho$; 0 in our examples),
#
# $$ f(x, y) = \frac{1}{2\pi\sigma_1\sigma_2\sqrt{1-\rho_{12}^2}}
#    \exp\left(-\frac{z_1^2 - 2\rho_{12} z_1 z_2 + z_2^2}{2(1-\rho_{12}^2)}\right). \tag{7} $$
#
# The paper calls this a probability. It is the right *density* for two offsets with a sign. A density has a unit, here
# 1/m², and may be larger than 1: with $\sigma_1 = \sigma_2 = 0.2$ m it is 4 per m² on the route. Only its integral over
# an area is a probability.
#
# Fig. 18 shows this density as a heat map. A red circle marks the *safety domain*, which "meets the requirements of the
# Pauta criterion". "Therefore", the paper concludes, its algorithm is "safe and reliable". The text that we have
# doesn't say how large the circle is. We draw two, by Eq. 5:

# %% tags=["check"]
joint = JointOffset(mean=(0.0, 0.0), sigma=(1.0, 1.0))
assert math.isclose(joint.circle(), offsets.pauta_radius(2), rel_tol=1e-9)
assert math.isclose(joint.within_circle(3.0), offsets.coverage(3, 2), rel_tol=1e-9)
assert f"{JointOffset((0, 0), (0.2, 0.2)).density((0, 0)):.1f}" == "4.0"
assert [round(5000 * (1 - offsets.coverage(radius, 2))) for radius in (3.0, joint.circle())] == [56, 13]

# %% tags=["figure"]
grid, angle = np.linspace(-4.5, 4.5, 181), np.linspace(0, 2 * np.pi, 181)
circle = np.column_stack([np.cos(angle), np.sin(angle)])
shown, distance = pushes[:5000, :2], np.hypot(*pushes[:5000, :2].T)
circles = {"circle of 3σ, holds 98.89 %": 3 * circle, "circle of 3.44σ, holds 99.73 %": joint.circle() * circle}
far = distance > joint.circle()
beyond = {"beyond 3σ, within 3.44σ": shown[(distance > 3) & ~far], "beyond 3.44σ": shown[far]}
plot.heat_map(grid, grid, joint.density(np.stack(np.meshgrid(grid, grid, indexing="ij"), axis=-1)),
              "horizontal offset [m]", "vertical offset [m]", "density f [1/m²]", paths=circles, points=beyond,
              equal=True, title=f"Of 5000 offsets, {np.sum(distance > 3)} lie beyond 3σ and {far.sum()} beyond 3.44σ",
              colors=dict(zip([*circles, *beyond], (ORANGE, BLUE, plot.YELLOW, PINK), strict=True)))  # fmt: skip

# %% [markdown]
# *A heat map in the manner of REPARE's Fig. 18, with $\sigma = 1$ m on both axes. Of 5000 offsets, only those beyond 3σ
# are marked* (by Eq. 5, 56 and 13 on average; 18 is chance). A circle of 3σ leaves out 1.11 %. To hold 99.73 % it has to
# have 3.44σ.
#
# ## A force that isn't Gaussian
#
# Drag grows with the *square* of the air speed (chapter [01](01_wind_and_rain.ipynb)). For a UAV that hovers, that is
# the wind speed. Let it be Gaussian, with a standard deviation of $I_u$ times its mean. $I_u$ is the *turbulence
# intensity*. The European standard EN 1991-1-4 gives $I_u = 1/\ln(H/z_0)$ at the height $H$ on level ground, with a
# *roughness length* $z_0$ of 1 m in cities: 0.29 at 30 m, our choice. We round to 0.3. Let $V$ be the wind speed in
# units of its mean, and $Q$ the force in units of the mean wind's:
#
# $$ Q = |V|\,V, \qquad V = 1 + I_u z, \qquad z \text{ standard normal.} \tag{8} $$
#
# $V < 0$ would mean that the wind turns round. Its chance is only 0.04 %, so nearly always $Q = V^2 = 1 + 2I_u z +
# I_u^2 z^2$. We write $\operatorname{E}$ for the mean and $\operatorname{Var}$ for the variance. With
# $\operatorname{E}z = \operatorname{E}z^3 = 0$, $\operatorname{E}z^2 = 1$ and $\operatorname{E}z^4 = 3$,
#
# $$ \operatorname{E}Q = 1 + I_u^2, \qquad
#    \operatorname{Var}Q = \operatorname{E}\bigl(2I_u z + I_u^2(z^2 - 1)\bigr)^2 = 4I_u^2 + 2I_u^4. \tag{9} $$
#
# A gust of $z = +1$ adds $2I_u + I_u^2$, and a lull of $z = -1$ takes away only $2I_u - I_u^2$. The law leans to one
# side. Its *skewness*, the mean cubed deviation over the cubed standard deviation, isn't 0 as for a Gaussian. We assume
# the worst for the offset: that it follows the force at once. Then it has the same shape,
#
# $$ x = \mu + \sigma\,\frac{Q - \operatorname{E}Q}{\sqrt{\operatorname{Var}Q}}. \tag{10} $$
#
# The larger $z$ is, the larger is $x$. So $x$ exceeds its value at $z = 3$ just when $z$ exceeds 3, with a chance of
# 0.135 %. With $\mu = 0$ this value is $(1.9^2 - 1.09)\,\sigma/0.613 = 4.11\sigma$. `SkewedOffset` is the law of Eq. 10,
# `OffsetModel` that of Eq. 1, `beyond` the chance to exceed an offset, and `quantile` the offset below which a share lies:

# %%
gaussian, city = OffsetModel(0.0, 1.0), SkewedOffset(mean=0.0, sigma=1.0, turbulence_intensity=0.3)
for law in (gaussian, city):
    far_out = law.quantile(1 - TOWARDS_WALL)
    print(f"{type(law).__name__:>12}: {law.beyond(3.0):.3%} beyond 3σ; 0.135 % beyond {far_out:.2f}σ")

# %% tags=["check", "nbval-check-output"]
drawn = city.sample(1_000_000, 9)
assert abs(np.mean(drawn > 3) - city.beyond(3.0)) < 4 * math.sqrt(city.beyond(3.0) / 1e6)
assert abs(stats.skew(drawn) - city.skewness) < 0.02
by_hand = ((1 + 0.3 * 3) ** 2 - (1 + 0.3**2)) / math.sqrt(4 * 0.3**2 + 2 * 0.3**4)
assert math.isclose(by_hand, city.boundary(), rel_tol=1e-3)
assert f"{math.sqrt(4 * 0.3**2 + 2 * 0.3**4):.3f}" == "0.613"
print(f"skewness {city.skewness:.2f}, {city.beyond(3.0) / gaussian.beyond(3.0):.1f} times")
print(
    f"turbulence at 30 m: city {1 / math.log(30 / 1.0):.2f}, coast {1 / math.log(30 / 0.003):.2f}; V < 0: {stats.norm.cdf(-1 / 0.3):.2%}"
)

# %% tags=["figure"]
x = np.linspace(-4, 6, 501)
laws = {"Gaussian": gaussian, "follows the force |V|V, turbulence 0.3": city}
colors = dict(zip(laws, (BLUE, ORANGE), strict=True)) | {"at 3σ": BLACK, "where 0.135 % are beyond": GREEN}
at = {"at 3σ": [(3, 100 * law.beyond(3)) for law in laws.values()],
      "where 0.135 % are beyond": [(city.boundary(), 0.135)]}  # fmt: skip
notes = {"0.88 %": (3, 0.88), "0.135 %": (3, 0.135), "4.11σ": (city.boundary(), 0.135)}
figure, (left, right) = plot.new_panels(1, 2, width=9.0, height=3.9)
plot.lines(x, {name: law.density(x) for name, law in laws.items()}, "offset downwind x − μ [σ]", "density [1/σ]",
           colors=colors, axes=left, title="Same mean, same σ …")  # fmt: skip
x = x[x >= 0]
plot.lines(x, {name: 100 * law.beyond(x) for name, law in laws.items()}, "offset downwind x − μ [σ]",
           "chance of more than x [%]", points=at, notes=notes, log="y",
           y_range=(1e-3, 100), colors=colors, axes=right, title="… but not the same tail")  # fmt: skip
figure

# %% [markdown]
# *Two offsets with the same mean and the same $\sigma$; the orange curve ends where $V = 0$.* Downwind, more than 3σ
# happens 6.5 times as often, and the Gaussian's 0.135 % is reached only at 4.1σ. A real UAV averages over several
# gusts, and a sum of many is nearer to a Gaussian.
#
# > **Try it.** On the coast $z_0$ is 0.003 m and $I_u$ about 0.1. How far out is the same share there?

# %% tags=["try-it"]
for intensity in (0.1, 0.3, 0.4):
    print(f"I_u = {intensity}: {SkewedOffset(0.0, 1.0, intensity).quantile(1 - TOWARDS_WALL):.2f}σ")

# %% [markdown]
# ## From a moment to a flight
#
# So far "0.135 %" was the chance *at one moment*. A flight has many moments, and neighbouring ones aren't independent:
# a UAV that is 2 m off now will be about 2 m off a tenth of a second later. How fast does the offset change?
#
# The simplest model of an autopilot is a spring with a damper. It pulls the UAV back to the route, the harder the
# farther it is off, and it brakes its speed:
#
# $$ \ddot x + 2\omega_n \dot x + \omega_n^2 x = \text{gusts [m/s}^2\text{]}. \tag{11} $$
#
# The *natural frequency* $\omega_n$, in rad/s, says how quickly the UAV comes back. The damping is that for which it comes
# back fastest without swinging past the route, an idealisation. We take the gusts to be *Gaussian white noise*: each push
# is Gaussian, and pushes at different moments are independent. They have blown for so long before the flight that the mean
# of $x^2$ no longer changes with time: the offset is *stationary*.
#
# PX4, a widely used autopilot, asks for a speed of 0.95 m/s back to the route for each metre of offset (`MPC_XY_P`),
# and for an acceleration of 1.8 m/s² for each m/s that is missing (`MPC_XY_VEL_P_ACC`). Without its integral and
# derivative terms, $\ddot x = 1.8\,(-0.95\,x - \dot x)$. So $\omega_n = \sqrt{1.8 \cdot 0.95} = 1.3$ rad/s. Its damping
# is 1.8 per second and not $2\omega_n$ = 2.6 as in Eq. 11: the *damping ratio* is 1.8/2.6 = 0.7. (Eq. 13 will hold for
# any.) uavlab's autopilot has $\omega_n$ = 1 rad/s. We take that, and look at 0.5 and 2 rad/s as well.

# %% tags=["check"]
assert round(math.sqrt(1.8 * 0.95), 1) == 1.3
assert f"{1.8 / (2 * math.sqrt(1.8 * 0.95)):.1f}" == "0.7"
assert Autopilot().controller.natural_frequency == 1.0

# %% tags=["figure"]
time, paths = offsets.offset_paths(sigma=1.0, duration=60.0, rng=6, count=3, natural_frequency=1.0)
flights = {f"simulated flight {number}": path for number, path in enumerate(paths, start=1)}
_, axes = plot.new_figure(7.2, 3.4)
plot.lines(time, flights, "time [s]", "offset towards the wall [σ]", limits={"the wall at 3σ": 3}, y_range=(-3.6, 3.9),
           axes=axes, title="One of three flights touches the wall (ω_n = 1 rad/s)",
           colors=dict(zip(flights, (BLUE, BLACK, ORANGE), strict=True)))  # fmt: skip

# %% [markdown]
# *Three flights of a minute, simulated with Eq. 11 and drawn on after a touch.* The body touches the wall when the offset
# is 3σ. We picked an example in which one flight does.
#
# ### How fast is an offset?
#
# To count crossings we need the standard deviation $\sigma_{\dot x}$ of the speed. Take the mean offset as 0, so that
# $\operatorname{E}x^2 = \sigma^2$. This doesn't change with time, so its derivative is 0:
#
# $$ \operatorname{E}\,x\dot x = \tfrac12\,\frac{d}{dt}\operatorname{E}x^2 = 0. \tag{12} $$
#
# Nor does $\operatorname{E}x\dot x$ change. We differentiate it with the product rule:
# $\operatorname{E}\dot x^2 + \operatorname{E}x\ddot x = 0$. To find $\operatorname{E}x\ddot x$, multiply Eq. 11 by $x$
# and take the mean of each term. Earlier pushes have made $x$, and the push of this moment is independent of them. So the
# right-hand side is 0: $\operatorname{E}x\ddot x + 2\omega_n\cdot 0 + \omega_n^2\sigma^2 = 0$, and
#
# $$ \sigma_{\dot x}^2 = \operatorname{E}\dot x^2 = -\operatorname{E}x\ddot x = \omega_n^2\sigma^2,
#    \qquad \sigma_{\dot x} = \omega_n\sigma. \tag{13} $$
#
# The damping is multiplied by 0, so Eq. 13 holds for any. (Real gusts last a while. With a correlation time of 1 s they
# would make $\sigma_{\dot x}/\sigma$ = 0.58 per second at $\omega_n$ = 1 rad/s: white noise is on the safe side.)
# Offset and speed are sums of the same Gaussian pushes, so they are *jointly* Gaussian: all their weighted sums are
# Gaussian, too. For such variables "uncorrelated" (Eq. 12) means "independent".

# %% tags=["check"]
assert (paths > 3).any(axis=1).tolist() == [False, True, False]
_, path = offsets.offset_paths(1.0, 20_000.0, 5, step=0.05, natural_frequency=1.3)
speed = np.diff(path[0]) / 0.05
assert abs(np.std(speed) / 1.3 - 1) < 0.04
assert abs(np.corrcoef(path[0, :-1] + path[0, 1:], speed)[0, 1]) < 0.02
rates = np.array([(0.0, 1.0, 0.0), (-1.0, -2.0, 1.0), (0.0, 0.0, -1.0)])  # offset, speed, and gusts that last 1 s
moments = linalg.solve_continuous_lyapunov(rates, -np.diag((0.0, 0.0, 1.0)))  # their covariance
assert f"{math.sqrt(moments[1, 1] / moments[0, 0]):.2f}" == "0.58"

# %% [markdown]
# ### Rice's formula
#
# How often does the offset cross a level $u$ upwards? Look at a short time $dt$. A path with the speed $\dot x > 0$
# rises by $\dot x\,dt$. It crosses $u$ in that time if it starts below $u$ by less than $\dot x\,dt$. Let $f_x$ and
# $f_{\dot x}$ be the densities of offset and speed. As the two are independent, the chance for that is
#
# $$ \int_0^\infty \underbrace{\int_{u - \dot x\,dt}^{u} f_x(x)\,dx}_{\approx\, f_x(u)\,\dot x\,dt}\; f_{\dot x}(\dot x)\,d\dot x
#    = dt\; f_x(u) \int_0^\infty \dot x\, f_{\dot x}(\dot x)\,d\dot x . $$
#
# Both densities are Gaussian (Eq. 1). The first is $f_x(u) = e^{-u^2/2\sigma^2}/(\sqrt{2\pi}\,\sigma)$. The integral is
# $\sigma_{\dot x}/\sqrt{2\pi}$, because $\dot x\,e^{-\dot x^2/2\sigma_{\dot x}^2}$ is the derivative of
# $-\sigma_{\dot x}^2\, e^{-\dot x^2/2\sigma_{\dot x}^2}$. Divided by $dt$, the number of crossings per second is
#
# $$ \nu = \frac{\sigma_{\dot x}}{2\pi\,\sigma}\; e^{-u^2/2\sigma^2} = \frac{\omega_n}{2\pi}\; e^{-u^2/2\sigma^2}. \tag{14} $$
#
# This is **Rice's formula**. The last step is Eq. 13.
#
# ### The chance to touch
#
# Let $u$ be the *room*: the distance $D$ between the route and the wall, minus half the body. At the start the UAV is
# outside of the wall with the chance $q = \Phi(u/\sigma)$. A crossing begins outside, where the UAV spends the share $q$ of
# the time. So per second *outside* there are $\nu/q$ crossings. If they don't depend on each other, there is none in the
# time $t$ with a chance of $e^{-\nu t/q}$. The chance to touch is then
#
# $$ P(t) \approx 1 - q\, e^{-\nu t/q}, \qquad P(t) \le (1 - q) + \nu t, \qquad q = \Phi(u/\sigma). \tag{15} $$
#
# The bound needs no independence: a flight that touches was in the wall at the start, or crosses at least once, and
# $\nu t$ is the mean number of crossings.


# %%
def chance_to_touch(distance, seconds, sigma=1.0, omega=1.0, body=1.0):
    """Chance to touch a wall at least once (Eq. 15, left)."""
    room = distance - body / 2
    outside = stats.norm.cdf(room / sigma)
    rate = omega / (2 * math.pi) * np.exp(-(room**2) / (2 * sigma**2))
    return 1 - outside * np.exp(-rate * seconds / outside)


# %% [markdown]
# > **Predict first.** A UAV of 1 m passes a wall at 3.5 m, with $\sigma = 1$ m: that is 3σ. At one moment the chance to
# > touch is 0.135 %. How large is it in eight seconds? (At 5 m/s that is a wall of 40 m.) In ten minutes, that is, for
# > 3 km of walls?

# %%
for when, seconds in {"one moment": 0, "8 s": 8, "1 min": 60, "10 min": 600}.items():
    chances = {omega: chance_to_touch(3.5, seconds, omega=omega) for omega in (0.5, 1.0, 2.0)}
    print(f"{when:>10}:", *(f"{chance:7.3%} ({omega:g} rad/s)" for omega, chance in chances.items()))

# %% tags=["check"]
for seconds in (0, 8, 60, 600):
    for omega in (0.5, 1.0, 2.0):
        library = offsets.collision_probability(3.5, 1.0, seconds, omega, uav_diameter=1.0)
        assert math.isclose(chance_to_touch(3.5, seconds, omega=omega), library, rel_tol=1e-9)
        assert library <= TOWARDS_WALL + seconds * offsets.crossing_rate(3.0, 1.0, omega)
for seconds, wanted in ((8, ["0.8", "1.5", "2.9"]), (600, ["41.3", "65.5", "88.1"])):
    assert [f"{100 * chance_to_touch(3.5, seconds, omega=omega):.1f}" for omega in (0.5, 1.0, 2.0)] == wanted
assert 6 < chance_to_touch(3.5, 8, omega=0.5) / TOWARDS_WALL < 11 < chance_to_touch(3.5, 8) / TOWARDS_WALL < 12

# %% [markdown]
# In eight seconds the chance is 1.5 %, eleven times that of a moment, and in ten minutes 65 %. With half the $\omega_n$,
# eight seconds still have six times the chance of a moment. 3σ isn't enough for a flight.
#
# ### Does the formula count right?
#
# We simulate flights with Eq. 11 and count. This checks our mathematics, but not the model.


# %%
def simulated(seconds, flights, batches):
    """Which flights touch a wall at 3σ, looked at every 0.02 s; and how often each crosses."""
    touched, crossings = [], []
    for seed in range(batches):
        beyond = offsets.offset_paths(1.0, seconds, seed, count=flights, step=0.02)[1] > 3.0
        touched.append(beyond.any(axis=1))
        crossings.append((beyond[:, 1:] & ~beyond[:, :-1]).sum(axis=1))
    return np.concatenate(touched), np.concatenate(crossings)


def interval(counts):
    """Mean, and the ends of the interval that holds the true mean in 95 of 100 such simulations."""
    half = 1.96 * counts.std() / math.sqrt(len(counts))  # within 1.96σ lie 95 % of a Gaussian
    return counts.mean(), counts.mean() - half, counts.mean() + half


# %%
short, long = simulated(8, 20_000, batches=10), simulated(600, 500, batches=4)
for seconds, (touched, crossings) in {8: short, 600: long}.items():
    chance, rice = chance_to_touch(3.5, seconds), seconds * offsets.crossing_rate(3.0, 1.0)
    group = crossings[crossings > 0].mean()
    print(f"{seconds:3d} s: {len(touched)} flights; those that cross do so {group:.2f} times")
    print("  touch {:.2%} [{:.2%}, {:.2%}]".format(*interval(touched)), f"Eq. 15: {chance:.2%}")
    print("  crossings {:.4f} [{:.4f}, {:.4f}]".format(*interval(crossings)), f"Eq. 14: {rice:.4f}")

# %% tags=["check"]
for seconds, (touched, crossings), times in ((8, short, 1.06), (600, long, 1.7)):
    _, low, high = interval(crossings)
    assert low < seconds * offsets.crossing_rate(3.0, 1.0) < high
    share, _, high = interval(touched)
    assert high < chance_to_touch(3.5, seconds) < 1.1 * share
    assert abs(crossings[crossings > 0].mean() / times - 1) < 0.03

# %% [markdown]
# In brackets stand 95 % intervals. The *number of crossings* agrees with Rice's formula. The *chance* of Eq. 15 is above
# the intervals. Crossings come in groups, so the same number of them falls on fewer flights. That is the safe side.

# %% tags=["figure"]
seconds = np.geomspace(0.1, 1800, 200)
walls = {f"wall at {k:g}σ": k for k in (3, 4, 5)}
chances = {name: 100 * chance_to_touch(k + 0.5, seconds) for name, k in walls.items()}
bands = {name: [100 * chance_to_touch(k + 0.5, seconds, omega=w) for w in (0.5, 2.0)] for name, k in walls.items()}
counted = {"simulated, wall at 3σ": [(8, 100 * short[0].mean()), (600, 100 * long[0].mean())]}
colors = dict(zip([*chances, *counted], (ORANGE, BLUE, BLACK, PINK), strict=True))
plot.lines(seconds, chances, "time beside the wall [s]", "chance to touch [%]", log="xy", bands=bands,
           band_label="ω_n from 0.5 to 2 rad/s (line: 1 rad/s)", y_range=(2e-5, 110), points=counted,
           limits={"0.135 %": 0.135}, title="The longer beside the wall, the likelier to touch it", colors=colors)  # fmt: skip

# %% [markdown]
# *The chance to touch a wall at least once, by Eq. 15.* To the left each curve flattens towards the chance of a moment.
#
# ### The k for a flight
#
# How large a chance per flight do you accept? 0.135 % is only the paper's share of a moment, carried over: one touch in
# 741 flights. For yours, divide the touches that you accept by the flights that you plan. SciPy's `brentq` finds the $k$
# for which Eq. 15 gives this share:


# %%
def k_for(seconds, share=TOWARDS_WALL, omega=1.0):
    """How many σ the room has to be, so that the chance to touch in a flight is `share`."""
    return optimize.brentq(lambda k: chance_to_touch(k, seconds, omega=omega, body=0.0) - share, 0.0, 20.0)


print("              8 s  1 min 10 min 30 min")
for omega in (0.5, 1.0, 2.0):
    print(f"{omega:3g} rad/s:", *(f"{k_for(seconds, omega=omega):6.2f}" for seconds in (8, 60, 600, 1800)))

# %% tags=["check", "nbval-check-output"]
assert all(0.135 < k_for(t, omega=2 * w) - k_for(t, omega=w) < 0.175 for t in (8, 60, 600, 1800) for w in (0.5, 1.0))
assert 1.2 < k_for(60) - 3 < 1.22
assert chance_to_touch(5.23, 600) <= TOWARDS_WALL < chance_to_touch(5.22, 600)
assert stats.norm.sf(4.73) + 600 * offsets.crossing_rate(4.73, 1.0) <= TOWARDS_WALL  # the bound, too
print(f"σ = 1 and 1.5 m: {k_for(600) + 0.5:.2f} and {1.5 * k_for(600) + 0.5:.2f} m")

# %% [markdown]
# A minute instead of a moment takes $k$ from 3 to 4.21. After that it grows slowly, because the exponential in Eq. 14 is
# so steep. Eq. 15 has only the product $\omega_n t$, so twice the time does the same as twice the $\omega_n$: 0.14 to 0.17
# more. $\sigma$ does more, because the room is $k\sigma$. For ten minutes $D_\text{min} = 4.73\cdot1 + 0.5 = 5.23$ m with
# $\sigma$ = 1 m, and 7.59 m with 1.5 m. Move the sliders and compare:


# %% tags=["figure"]
def turn(sigma=1.0, omega=1.0, seconds=600):
    """The chance to touch over the distance from the wall; body 1 m."""
    distance = np.linspace(0.5, 8.5, 341)
    moment, flight = (100 * chance_to_touch(distance, t, sigma, omega) for t in (0, seconds))
    needed = sigma * k_for(seconds, omega=omega) + 0.5
    return plot.lines(distance, {"at one moment": moment, "in the whole flight": flight},
                      "distance of the route from the wall [m]", "chance to touch [%]", log="y", limits={"0.135 %": 0.135},
                      places={f"D_min = {needed:.2f} m": needed}, y_range=(1e-3, 110),
                      title=f"σ = {sigma:g} m, ω_n = {omega:g} rad/s, {seconds} s beside the wall, body 1 m",
                      colors={"at one moment": BLUE, "in the whole flight": ORANGE, f"D_min = {needed:.2f} m": PINK})  # fmt: skip


labels = {"sigma": "σ [m]", "omega": "ω_n [rad/s]", "seconds": "time beside the wall [s]"}
plot.sliders(turn, title="chance to touch a wall", labels=labels, sigma=[1.0, 1.5], omega=[0.5, 1.0, 1.3, 2.0],
             seconds=[8, 60, 600, 1800], start={"sigma": 1.0, "omega": 1.0, "seconds": 600}, progress=False)  # fmt: skip

# %% [markdown]
# *The chance to touch over the distance.* $D_\text{min}$ is where the orange curve meets 0.135 %.
#
# ## Wind towards the wall
#
# A steady wind that the autopilot doesn't know leaves a *mean offset*, now a vector $\boldsymbol\mu$. Let the unit vector
# $\mathbf n$ point away from the wall. The room becomes $u = D - \frac12D_\text{uav} + \boldsymbol\mu\cdot\mathbf n$,
# which is smaller where the wind holds the UAV nearer to the wall. There the distance has to grow. On the other side we
# don't make it smaller, because the wind may drop, and then the mean offset is 0:
#
# $$ D_\text{min} = k\sigma + \tfrac12 D_\text{uav} + \max(0, -\boldsymbol\mu\cdot\mathbf n). \tag{16} $$
#
# `minimum_safe_distance` computes it from $\xi = k\sigma$ and $D_\text{uav}$. We pass one side of a building of 40 m by
# 40 m at 5 m/s, so in eight seconds. The wind holds the UAV 2 m to the east (invented):

# %%
held, xi = np.array([2.0, 0.0]), k_for(8) * 1.0  # mean offset east and north [m]; kσ [m]
for side, normal in {"west": (-1, 0), "south": (0, -1), "east": (1, 0)}.items():
    away = held @ normal
    keep = offsets.minimum_safe_distance(xi, 1.0, mean_offset=held, normal=normal)
    print(
        f"{side:>5} of a building: at {xi + 0.5:.2f} m {chance_to_touch(xi + 0.5 + away, 8):7.3%}, "
        f"at D_min = {keep:.2f} m {chance_to_touch(keep + away, 8):.3%}"
    )

# %% tags=["check"]
for normal in ((-1, 0), (0, -1), (1, 0)):
    keep = offsets.minimum_safe_distance(xi, 1.0, mean_offset=held, normal=normal)
    touch = offsets.collision_probability(keep, 1.0, 8.0, uav_diameter=1.0, mean_away=held @ np.array(normal))
    assert touch < 0.001351
assert f"{chance_to_touch(xi + 0.5 - 2, 8):.0%}" == "29%"

# %% [markdown]
# Without the last term of Eq. 16, 29 % of the flights would touch on the west side, and not 0.135 %.

# %% tags=["figure"]
corners = np.array([(20, 20), (-20, 20), (-20, -20), (20, -20)])
quarters = np.radians(np.linspace(np.arange(0, 360, 90), np.arange(90, 450, 90), 61).T)  # around each corner
normal = np.stack([np.cos(quarters), np.sin(quarters)], axis=-1)
zones = {}
for name, offset in {"without wind, 4.2 m": (0.0, 0.0), "with the wind (Eq. 16)": held}.items():
    keep = offsets.minimum_safe_distance(xi, 1.0, mean_offset=offset, normal=normal)
    outline = (corners[:, None] + keep[..., None] * normal).reshape(-1, 2)
    zones[name] = np.vstack([outline, outline[:1]])
gap, arrow = {"6.2 m": [(-26.22, 8), (-20, 8)]}, "mean offset, 2 m to the east"
plot.diagram("x, east [m]", "y, north [m]", paths=zones | {"D_min in the west": gap["6.2 m"]}, areas={"building": corners},
             notes={"6.2 m": (-23, 8)}, arrows={arrow: [(-34, -8), (-32, -8)]}, x_range=(-36, 28), y_range=(-28, 28),
             title="The wind moves the western line out by 2 m",
             colors=dict(zip([*zones, "D_min in the west", "building", arrow], (BLUE, ORANGE, PINK, "0.35", BLACK), strict=True)))  # fmt: skip

# %% [markdown]
# *A building from above. The route must stay outside of the line.* In the east both lines are the
# same. At the western corners Eq. 16, made for straight walls, asks for a little too much.
#
# ## Which k for which question?
#
# We compare for one wall, with $\omega_n = 1$ rad/s and **0.135 %** in every row. One row is for a skewed offset *in
# flight*: Eq. 10 makes $x$ from $z$ at each moment. If $z$ moves like Eq. 11, ten minutes need its value at
# $z$ = 4.726: $((1 + 0.3\cdot4.726)^2 - 1.09)\,\sigma/0.6134 = 7.75\sigma$.

# %%
k_of = {
    "one moment (REPARE's 3σ)": 3.0,
    "one moment, downwind, turbulence 0.3": city.quantile(1 - TOWARDS_WALL),
    "8 seconds": k_for(8),
    "1 minute": k_for(60),
    "10 minutes": k_for(600),
    "10 minutes, downwind, turbulence 0.3": city.quantile(stats.norm.cdf(k_for(600))),
}
for question, k in k_of.items():
    print(f"{question:<36} k = {k:.2f}, D_min = {k + 0.5:.2f} m")

# %% tags=["check"]
assert [round(float(k), 2) for k in k_of.values()] == [3.0, 4.11, 3.72, 4.21, 4.73, 7.75]
assert f"{k_for(600):.3f} {((1 + 0.3 * 4.726) ** 2 - 1.09) / 0.6134:.2f}" == "4.726 7.75"
assert f"{stats.norm.sf(4.73) + 600 * offsets.crossing_rate(4.73, 1.0):.3%}" == "0.132%"

# %% [markdown]
# $D_\text{min}$ goes from 3.5 to 8.25 m. We recommend:
#
# | your question | take |
# |---|---|
# | Is this sample a gross error? | 3σ, on both sides, with 20 samples or more; look at what goes |
# | Within which distance of the route is the UAV at a given moment, with 99.73 %? | 3.44σ in a plane, 3.76σ in three dimensions |
# | How near to a wall may I fly? | $k$ from Eq. 15, for the time beside walls, the chance that you accept, and the largest $\omega_n$ that you think possible |
# | And if the offset is skewed? | fit `SkewedOffset` to samples, and put this $k$ for $z$ into Eq. 10 |
#
# **A UAV of 1 m with $\sigma = 1$ m and $\omega_n = 1$ rad/s that keeps 5.23 m ($k = 4.73$) from walls touches them in ten
# minutes with a chance of at most 0.135 %** (the bound of Eq. 15 is 0.132 %). That holds if the offset is Gaussian and
# follows Eq. 11, if its mean is 0, and if $\sigma$ and the position are known. Each "if" can fail: in a city, a skewed
# offset that follows each gust at once would ask for 8.25 m. Chapter [03](03_predicting_the_disturbance.ipynb) asks where
# $\sigma$ comes from, and chapter [13](13_flying_in_gusts.ipynb) flies.
#
# > **Try it.** You make 1000 flights of ten minutes a year, and accept one touch in ten years: 1 in 10 000. Which distance
# > do you have to keep? And if $\sigma$ is really 1.2 m: how often do you touch then?

# %% tags=["try-it"]
mine = k_for(600, share=1e-4) + 0.5
print(f"{mine:.2f} m; with σ = 1.2 m there: {chance_to_touch(mine, 600, sigma=1.2):.2%}")

# %% [markdown]
# 5.75 m. With 20 % more $\sigma$ you touch 67 times as often as you meant to.
#
# ## Remember
#
# - At one moment 3σ holds 99.73 % on one axis, 98.89 % in a plane and 97.07 % in three dimensions. Towards one wall it
#   leaves out 0.135 %.
# - A filter by 3σ finds nothing among ten samples or fewer, and of 1000 good samples it removes about three.
# - A smooth random signal crosses a level $\nu = (\omega_n/2\pi)\,e^{-u^2/2\sigma^2}$ times per second (Rice's formula).
# - A share per moment isn't a share per flight. At 3σ, 0.135 % becomes 1.5 % in eight seconds and 65 % in ten minutes
#   ($\omega_n$ = 1 rad/s; simulated 1.4 and 62 %).
# - To keep 0.135 % for a minute at $\omega_n$ = 1 rad/s, $k$ has to be 4.2. Twice the time or twice the $\omega_n$ adds only
#   about 0.15.
#
# ## What the paper says, what we find

# %% tags=["check"]
assert f"{offsets.coverage(3, 2):.2%} {offsets.coverage(3, 3):.2%}" == "98.89% 97.07%"
assert f"{city.skewness:.2f} {city.beyond(3.0) / gaussian.beyond(3.0):.1f}" == "0.87 6.5"
assert f"{chance_to_touch(3.5, 8):.1%} {chance_to_touch(3.5, 600):.0%}" == "1.5% 65%"
assert f"{short[0].mean():.1%} {long[0].mean():.0%}" == "1.4% 62%"

# %% [markdown]
# | REPARE | says | we find |
# |---|---|---|
# | section 2.2.2 | the disturbing force is approximately Gaussian | a force $\propto \lvert V\rvert V$ isn't: skewness 0.87 at turbulence 0.3, and 6.5 times the chance beyond 3σ, if the offset follows the force at once |
# | section 2.2.2 | 3σ holds 99.7 % | true on one axis at one moment: 99.73 %; 98.89 % in a plane, 97.07 % in 3 D |
# | Eq. 7 | $D_\text{min} \ge \xi + D_\text{uav}/2$ | right; $\xi = k\sigma$ with a $k$ that belongs to the question |
# | Table 4 | 3.5, 4.5, 5.5 m | in the text that we have, no σ and no body are given; with a body of 1 m and $k = 3$ they mean $\sigma = (3.5 - 0.5)/3 = 1$ m, 1.33 and 1.67 m |
# | Eq. 17 | the joint probability | the right formula for the *density* of two signed, jointly Gaussian offsets; a distance has another law (Eq. 5) |
# | Fig. 18 | the red circle meets the criterion | with $\sigma_1 = \sigma_2$ and $\rho_{12} = 0$ it holds 99.73 % only if its radius is 3.44σ or more; the text that we have gives no radius |
# | section 3.4 | the algorithm is "safe and reliable" | not shown by a share per moment: at 3σ and $\omega_n$ = 1 rad/s, 1.5 % of passes of 8 s touch by Eq. 15 (simulated with the same model: 1.4 %), and 65 % of those of 10 min (62 %) |
#
# ## Read on
#
# - F. Pukelsheim, "The three sigma rule", *The American Statistician* 48 (1994) 88–91,
#   [doi:10.1080/00031305.1994.10476030](https://doi.org/10.1080/00031305.1994.10476030): the rule
#   when nothing is normally distributed.
# - S. O. Rice, "Mathematical analysis of random noise", *Bell System Technical Journal* 24 (1945) 46–156,
#   [doi:10.1002/j.1538-7305.1945.tb00453.x](https://doi.org/10.1002/j.1538-7305.1945.tb00453.x): level
#   crossings.
# - R. E. Shiffler, "Maximum Z scores and outliers", *The American Statistician* 42 (1988) 79–80,
#   [doi:10.1080/00031305.1988.10475530](https://doi.org/10.1080/00031305.1988.10475530): the proof of Eq. 4.
# - *PX4 User Guide*, "Parameter Reference",
#   [docs.px4.io](https://docs.px4.io/main/en/advanced_config/parameter_reference): the gains of a real autopilot
#   (`MPC_XY_P`, `MPC_XY_VEL_P_ACC`).
# - EN 1991-1-4, *Eurocode 1: Actions on structures, Part 1-4: Wind actions*, sections 4.3 and 4.4,
#   [eurocodes.jrc.ec.europa.eu](https://eurocodes.jrc.ec.europa.eu): turbulence.
#
# ## Your turn
#
# Six exercises: what 3σ promises, how much the plane holds, the distance to keep with wind, how long a flight may be,
# how many errors the filter bears, and a route through a street of your own:
# [exercises/02_pauta_exercises.ipynb](exercises/02_pauta_exercises.ipynb).
#
# Before: [01 wind and rain](01_wind_and_rain.ipynb). Next: [03 predicting the
# disturbance](03_predicting_the_disturbance.ipynb).
