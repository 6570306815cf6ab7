# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 02 The Pauta criterion: how far does a gust reach?
#
# Gusts push a UAV off its route, at random. How far from a wall is far enough? REPARE (Sensors 2022, 22, 2151,
# [doi:10.3390/s22062151](https://doi.org/10.3390/s22062151), sections 2.2.2, 2.3.1 and 3.4, Eqs 6, 7 and 17) answers
# with a rule from the workshop of measurement, the *Pauta criterion*: three standard deviations hold 99.7 % of all
# that happens by chance, so three standard deviations and half the body are enough. We draw what the paper means, and
# then ask where "99.7 %" stops being true: in the plane and in space, for a distance instead of an offset, for a force
# that isn't Gaussian, and over a flight instead of at a moment. At the end stands a distance to keep that means what it
# says. ("Eq. 3" is an equation of this notebook, "REPARE Eq. 6" one of the paper's.)

# %%
import math

import numpy as np
from scipy import stats

from uavlab import offsets, plot
from uavlab.offsets import JointOffset, OffsetModel, SkewedOffset

BLACK, BLUE, GREEN, ORANGE, PINK, YELLOW = plot.BLACK, plot.BLUE, plot.GREEN, plot.ORANGE, plot.PINK, plot.YELLOW

# %% [markdown]
# ## One axis: what the criterion says
#
# Let $x$ be the offset from the route on one axis, in metres, say to the right of it. REPARE Eq. 6 takes it for
# Gaussian, with mean $\mu$ and standard deviation $\sigma$, the paper's *risk level*:
#
# $$ n(x) = \frac{1}{\sqrt{2\pi}\,\sigma} \exp\left(-\frac{(x-\mu)^2}{2\sigma^2}\right). \tag{1} $$
#
# The share of all offsets within $k$ standard deviations of the mean follows by integrating:
#
# $$ P_1(k) = \int_{\mu-k\sigma}^{\mu+k\sigma} n(x)\,dx = \operatorname{erf}\frac{k}{\sqrt 2}. \tag{2} $$

# %% tags=["nbval-check-output"]
for k in (1, 2, 3, 4):
    print(f"within {k}σ on one axis: {offsets.coverage(k, dimensions=1):9.4%}")
assert math.isclose(offsets.coverage(3, 1), math.erf(3 / math.sqrt(2)), rel_tol=1e-12)
assert round(offsets.PAUTA_COVERAGE, 4) == 0.9973

# %% [markdown]
# This is REPARE Fig. 2: what lies in the green part is chance, what lies outside is taken for a *gross error*, or, for
# a UAV, for a push it needn't survive.

# %% tags=["figure"]
x = np.linspace(-4.5, 4.5, 901)
density = OffsetModel(mean=0.0, sigma=1.0).density(x)
within, beyond = "within 3σ: 99.73 %", "beyond: 0.135 % on each side"
bands = {within: (0, np.where(np.abs(x) <= 3, density, np.nan)), beyond: (0, np.where(np.abs(x) >= 3, density, np.nan))}
shown = {"places": {"−3σ": -3, "3σ": 3}, "bands": bands, "colors": {within: GREEN, beyond: ORANGE}}
figure, panels = plot.new_panels(1, 2, width=9.0, height=3.7)
tops = {"The Pauta criterion (REPARE Fig. 2)": 0.42, "enlarged, to see 0.27 %": 0.012}
for axes, (title, top) in zip(panels, tops.items(), strict=True):
    plot.lines(x, {"density": density}, "offset x on one axis [σ]", "density n(x) [1/σ]", y_range=(0, top), title=title,
               axes=axes, **shown)  # fmt: skip
figure

# %% [markdown]
# ## Several risk levels, and the distance to keep
#
# In more wind, or with a heavier load, $\sigma$ is larger, and the same share needs more room. REPARE Fig. 3 draws
# densities of several risk levels, each with its *safety discriminant points*, here $\mu \pm 3\sigma$. The distance
# to keep from obstacles is REPARE Eq. 7: the offset $\xi$ to be survived plus half the body,
#
# $$ D_\text{min} \ge \xi + \tfrac12 D_\text{uav}, \qquad \xi = k\,\sigma, \tag{3} $$
#
# with $k = 3$ in the paper. For a body of $D_\text{uav} = 1$ m, which $\sigma$ gives the three distances of its
# Table 4?

# %% tags=["nbval-check-output"]
levels = {"light load, mild wind": 1.0, "heavy load, mild wind": 4 / 3, "light load, heavy wind": 5 / 3}
for name, sigma in levels.items():
    distance = offsets.minimum_safe_distance(3 * sigma, uav_diameter=1.0)
    print(f"{name:<22} σ = {sigma:.2f} m: ξ = 3σ = {3 * sigma:.1f} m, D_min = {distance:.1f} m")
distances = offsets.minimum_safe_distance(3 * np.array(list(levels.values())), uav_diameter=1.0)
assert np.allclose(distances, [3.5, 4.5, 5.5])

# %% tags=["figure"]
x = np.linspace(-6.5, 6.5, 651)
models = {f"{name}: σ = {sigma:.2f} m": OffsetModel(0.0, sigma) for name, sigma in levels.items()}
densities = {name: level.density(x) for name, level in models.items()}
ends = {name: np.array([-1, 1]) * level.boundary() for name, level in models.items()}
points = {name: np.column_stack([ends[name], level.density(ends[name])]) for name, level in models.items()}
notes = {f"3σ = {points[name][1, 0]:.0f} m": points[name][1] for name in models}
plot.lines(x, densities, "offset x on one axis [m]", "density n(x) [1/m]", points=points, notes=notes,
           point_label="safety discriminant points, 3σ", title="Risk levels and what each has to survive (REPARE Fig. 3)",
           colors=dict(zip(models, (BLUE, BLACK, ORANGE), strict=True)))  # fmt: skip

# %% [markdown]
# ## What the criterion was made for: gross errors
#
# Before there is a $\sigma$ there are samples, and among them some that are wrong: the position sensor jumped, somebody
# touched the UAV. The criterion removes what lies beyond $3\sigma$. But a gross error widens the very $\sigma$ that it
# is judged by, so one round isn't enough: remove, compute mean and $\sigma$ anew, and go on until nothing is removed.
# 200 good offsets with $\sigma = 0.8$ m and 8 wrong ones:

# %% tags=["nbval-check-output"]
rng = np.random.default_rng(2)
wrong = np.array([4.5, -5.0, 6.0, 9.0, -14.0, 25.0, 40.0, -70.0])
samples = np.concatenate([OffsetModel(0.2, 0.8).sample(200, rng), wrong])
kept = np.ones(len(samples), dtype=bool)
bounds = []
for round_number in range(1, 10):
    good = OffsetModel.fit(samples[kept])
    bounds.append((good.mean - 3 * good.sigma, good.mean + 3 * good.sigma))
    print(f"round {round_number}: σ = {good.sigma:5.2f} m from {kept.sum()} samples")
    remaining = kept & (samples >= bounds[-1][0]) & (samples <= bounds[-1][1])
    if remaining.sum() == kept.sum():
        break
    kept = remaining
found = offsets.pauta_filter(samples)
assert (kept == found.kept).all()
assert not found.kept[200:].any()
print(f"pauta_filter: {found.rounds} rounds, μ = {found.mean:.2f} m, σ = {found.sigma:.2f} m, removed {(~kept).sum()}")

# %% tags=["figure"]
rounds, means, reach = np.arange(1, len(bounds) + 1), np.mean(bounds, axis=1), np.diff(bounds)[:, 0] / 2
away = np.abs(samples - means[:, None])  # of each sample in each round
removed = np.cumsum(away > reach[:, None], axis=0) - (away > reach[:, None]) > 0  # in a round before
away[removed] = np.nan
parts = {"gross error, until it is removed": away[:, 200:], "good sample": away[:, :200]}
points = {name: np.column_stack([np.repeat(rounds, part.shape[1]), part.ravel()]) for name, part in parts.items()}
limit = {"3σ in this round: what lies above is removed": reach}
figure = plot.lines(rounds, limit, "round", "distance from the mean [m]", points=points, log="y", y_range=(0.01, 150))
figure.axes[0].set_xticks(rounds)
figure

# %% [markdown]
# In the first round the largest errors hide the others. Two warnings. The filter looks for what is far from the rest,
# so it takes rare strong gusts as well: never filter the data that safety is computed from without looking at what
# goes. And with few samples it can't find anything. Put one sample at $a$ and $n - 1$ at 0; however large $a$ is,
#
# $$ \frac{|a - \bar x|}{s} = \frac{n-1}{\sqrt n}, \tag{4} $$
#
# and no sample of $n$ can do better. That is below 3 up to $n = 10$.

# %% tags=["nbval-check-output"]
for count in (5, 10, 11):
    spike = np.zeros(count)
    spike[-1] = 1000.0
    z = (spike[-1] - spike.mean()) / spike.std(ddof=1)
    assert math.isclose(z, (count - 1) / math.sqrt(count))
    print(f"n = {count:2d}: 1000 m among zeros is {z:.2f}σ from the mean")
try:
    offsets.pauta_filter([0.1, -0.2, 0.3, 1000.0])
except ValueError as error:
    print(error)

# %% [markdown]
# ## Two axes and three
#
# A UAV isn't pushed along one axis. Take two with the same $\sigma$, independent, and ask for the chance to be within a
# *radius* of $k\sigma$. In polar coordinates ($r$ in units of $\sigma$) the ring from $r$ to $r + dr$ is $2\pi r\,dr$
# large, so
#
# $$ P_2(k) = \int_0^k \frac{1}{2\pi} e^{-r^2/2}\; 2\pi r\,dr = 1 - e^{-k^2/2}. \tag{5} $$
#
# In general the sum of $d$ squared standard normal variables follows the chi-square law with $d$ degrees of freedom:
#
# $$ P_d(k) = P(\chi^2_d \le k^2), \qquad k_d(P) = \sqrt{\text{quantile of } \chi^2_d \text{ at } P}. \tag{6} $$
#
# `offsets.coverage` is the first, `offsets.pauta_radius` the second. A million drawn offsets agree:

# %% tags=["nbval-check-output"]
for dimensions in (1, 2, 3):
    exact, radius = offsets.coverage(3, dimensions), offsets.pauta_radius(dimensions)
    drawn = np.linalg.norm(np.random.default_rng(dimensions).standard_normal((1_000_000, dimensions)), axis=1)
    print(f"{dimensions} D: 3σ holds {exact:.3%} (drawn {np.mean(drawn <= 3):.2%}), 99.73 % needs {radius:.3f}σ")
    assert abs(np.mean(drawn <= 3) - exact) < 4 * math.sqrt(exact * (1 - exact) / 1e6)
assert math.isclose(offsets.coverage(3, 2), 1 - math.exp(-4.5))
assert math.isclose(offsets.pauta_radius(2), math.sqrt(stats.chi2.ppf(offsets.PAUTA_COVERAGE, 2)), abs_tol=1e-12)

# %% tags=["figure"]
k, dimensions = np.linspace(0, 5, 501), (1, 2, 3)
beyond = {f"{d} D": 100 * (1 - offsets.coverage(k, d)) for d in dimensions}
outside = [(3, 100 * (1 - offsets.coverage(3, d))) for d in dimensions]
radii = [(offsets.pauta_radius(d), 0.27) for d in dimensions]
points = {"what 3σ leaves outside": outside, "radius for 0.27 %": radii}
notes = {f"{at[1]:.2f} %": at for at in outside} | {f"{at[0]:.2f}σ": at for at in radii}
plot.lines(k, beyond, "radius k [σ]", "chance to be beyond [%]", points=points, notes=notes, limits={"Pauta: 0.27 %": 0.27},
           log="y", y_range=(0.01, 110), colors={"1 D": BLUE, "2 D": BLACK, "3 D": ORANGE})  # fmt: skip

# %% [markdown]
# Discs: what $3\sigma$ leaves outside. Triangles: what radius the criterion's own 0.27 % needs. The same three standard
# deviations leave out four times as much in the plane, and eleven times as much in space.
#
# Turn it yourself:


# %%
def turn(sigma=1.0, dimensions=2):
    """The law of the distance from the route, what 3σ leaves outside, and the distance to keep."""
    radius = offsets.pauta_radius(dimensions)
    r = np.linspace(0, 9, 601)
    density = stats.chi(dimensions, scale=sigma).pdf(r)
    keep = offsets.minimum_safe_distance(radius * sigma, uav_diameter=1.0)
    places = {f"3σ = {3 * sigma:.2f} m": 3 * sigma, f"99.73 % within {radius * sigma:.2f} m": radius * sigma}
    law = f"distance from the route, {dimensions} D"
    return plot.lines(r, {law: density}, "distance from the route [m]", "density [1/m]", places=places,
                      bands={"beyond 3σ": (0, np.where(r >= 3 * sigma, density, np.nan))},
                      title=f"3σ holds {offsets.coverage(3, dimensions):.2%}; D_min = {keep:.2f} m (body 1 m)",
                      colors={"beyond 3σ": ORANGE})  # fmt: skip


# %%
labels, values = (
    {"sigma": "σ [m]", "dimensions": "dimensions"},
    {"sigma": [0.2, 0.5, 1.0, 1.5, 2.0], "dimensions": [1, 2, 3]},
)
plot.sliders(
    turn, title="law of the distance", labels=labels, start={"sigma": 1.0, "dimensions": 2}, progress=False, **values
)

# %% [markdown]
# ## Fig. 18: a circle that is one eighth too small
#
# REPARE section 3.4 puts two offsets together, $\xi_\text{ver}$ perpendicular to the ground and $\xi_\text{hor}$
# parallel to it, and gives their joint density (REPARE Eq. 17). With $u = (x - \mu_1)/\sigma_1$,
# $v = (y - \mu_2)/\sigma_2$ and the correlation $\rho$,
#
# $$ f(x, y) = \frac{1}{2\pi\sigma_1\sigma_2\sqrt{1-\rho^2}} \exp\left(-\frac{u^2 - 2\rho uv + v^2}{2(1-\rho^2)}\right).
# \tag{7} $$
#
# The formula is right; that it is called a probability isn't. It is a density, per square metre: for
# $\sigma = 0.2$ m it reaches 4. Only an integral over an area is a probability. Fig. 18 draws this "probability" as a
# heat map, marks the safety domain with a red circle, and says that it meets the Pauta criterion. With the $3\sigma$ of
# Figs 2 and 3 as its radius it doesn't: that is Eq. 5.

# %% tags=["nbval-check-output"]
calm, joint = JointOffset((0, 0), (0.2, 0.2)), JointOffset((0, 0), (1, 1))
print(f"highest density for σ = 0.2 m: {calm.density((0, 0)):.2f} per m²")
pushes = joint.sample(1_000_000, 18)
for name, radius in {"3σ": 3.0, "3.44σ": joint.circle()}.items():
    drawn = np.mean(np.hypot(*pushes.T) > radius)
    print(f"circle of {name:<6} leaves out {1 - joint.within_circle(radius):.3%}, drawn {drawn:.2%}")
print(f"3σ is {1 - 3 / joint.circle():.1%} too small: about one eighth")
assert calm.density((0, 0)) > 1
assert math.isclose(joint.circle(), offsets.pauta_radius(2), rel_tol=1e-9)
assert abs(1 - 3 / joint.circle() - 1 / 8) < 0.004

# %% tags=["figure"]
grid = np.linspace(-4.5, 4.5, 91)
angle = np.linspace(0, 2 * np.pi, 181)
circle = np.column_stack([np.cos(angle), np.sin(angle)])
shown, distance = pushes[:5000], np.hypot(*pushes[:5000].T)
circles = {"the paper's circle, 3σ: 98.89 %": 3 * circle, "circle of 3.44σ: 99.73 %": joint.circle() * circle}
far = distance > joint.circle()
beyond = {"beyond 3σ": shown[(distance > 3) & ~far], "beyond 3.44σ, too": shown[far]}
plot.heat_map(grid, grid, joint.density(np.stack(np.meshgrid(grid, grid, indexing="ij"), axis=-1)),
              "horizontal offset [m]", "vertical offset [m]", "density f [1/m²], σ = 1 m", paths=circles, points=beyond,
              equal=True, title=f"REPARE Fig. 18: {np.sum(distance > 3)} of 5000 offsets beyond 3σ",
              colors=dict(zip([*circles, *beyond], (ORANGE, BLUE, YELLOW, PINK), strict=True)))  # fmt: skip

# %% [markdown]
# The axes need neither the same $\sigma$ nor independence: wind that pushes sideways also tilts the UAV, and a tilted
# UAV sinks. Then the curves of equal density are ellipses, and the ellipse of $k\sigma$ still holds what Eq. 5 says.
# Its shape says in which direction room is needed. If the direction of the next wall isn't known, what counts is the
# circle around the *route* that holds the share.

# %% tags=["nbval-check-output"]
tilted = JointOffset(mean=(0.6, -0.3), sigma=(1.0, 0.5), correlation=-0.6)
pushes = tilted.sample(200_000, 17)
print(
    f"3σ ellipse holds {np.mean(tilted.radius_in_sigma(pushes) <= 3):.2%} of the drawn, Eq. 5: {1 - math.exp(-4.5):.2%}"
)
print(f"99.73 % lie within {tilted.circle():.2f} m of the route; Eq. 3 with the worse axis gives ξ = 3.00 m")
refitted = JointOffset.fit(pushes)
print(
    f"fitted from the samples: σ = {refitted.sigma[0]:.2f}, {refitted.sigma[1]:.2f} m, ρ = {refitted.correlation:.2f}"
)
assert abs(np.mean(np.hypot(*pushes.T) <= tilted.circle()) - offsets.PAUTA_COVERAGE) < 5e-4

# %% tags=["figure"]
outlines = {
    "ellipse, 99.73 %": tilted.ellipse(),
    "ellipse of 3σ, 98.89 %": tilted.ellipse(offsets.coverage(3, 2)),
    "circle, 99.73 %": tilted.circle() * circle,
}
points = {"route": (0, 0), "mean offset": tilted.mean, "a drawn offset": pushes[:1000]}
colors = dict(zip([*outlines, *points], (BLUE, PINK, ORANGE, BLACK, GREEN, "0.5"), strict=True))
plot.diagram("horizontal offset [m]", "vertical offset [m]", paths=outlines, points=points, colors=colors)

# %% [markdown]
# ## A distance is not an offset
#
# What does $\xi_\text{hor}$, "parallel to the ground", mean? There are two directions parallel to the ground. If it is
# one *signed* axis, say across the route, Eq. 7 fits. If it is how far the UAV is from its route in the plan, then it
# is a magnitude, $\sqrt{x^2 + y^2}$: never negative, and not Gaussian. Its density is the integrand of Eq. 5, the
# Rayleigh law, and with a mean offset $m$ the Rice law ($I_0$ is a Bessel function):
#
# $$ p(r) = \frac{r}{\sigma^2} e^{-r^2/2\sigma^2}, \qquad
#    p(r) = \frac{r}{\sigma^2} e^{-(r^2+m^2)/2\sigma^2}\, I_0\!\left(\frac{rm}{\sigma^2}\right). \tag{8} $$
#
# Who records magnitudes and applies "mean plus three standard deviations" to them gets this:

# %% tags=["nbval-check-output"]
law = offsets.magnitude(sigma=1.0)
rule = law.mean() + 3 * law.std()
print(
    f"Rayleigh: mean {law.mean():.4f}σ, standard deviation {law.std():.4f}σ, 99.73 % within {law.ppf(0.9973002):.3f}σ"
)
print(f"mean + 3 standard deviations = {rule:.2f}σ: beyond it {law.sf(rule):.2%}, not 0.135 %")
for mean_length in (0.0, 1.0, 2.0):
    reach = offsets.magnitude(1.0, mean_length).ppf(offsets.PAUTA_COVERAGE)
    print(f"mean offset {mean_length:.0f}σ: 99.73 % within {reach:.2f}σ")
assert math.isclose(law.mean(), math.sqrt(math.pi / 2))
assert math.isclose(law.ppf(offsets.PAUTA_COVERAGE), offsets.pauta_radius(2))

# %% tags=["figure"]
r = np.linspace(0, 6.5, 651)
drawn = np.hypot(*np.random.default_rng(8).standard_normal((2, 100_000)))
heights = np.histogram(drawn, bins=np.arange(0, 6.65, 0.1), density=True)[0]
densities = {
    "Rayleigh (Eq. 8)": law.pdf(r),
    "Gaussian, same mean and σ": OffsetModel(law.mean(), law.std()).density(r),
    "Rice: mean offset 2σ": offsets.magnitude(1.0, 2.0).pdf(r),
}
gaussian_end, end = f"Gaussian: mean + 3 deviations, {rule:.2f}σ", "Rayleigh: 99.73 %, 3.44σ"
plot.lines(r, densities, "distance from the route in the plan [σ]", "density [1/σ]", places={gaussian_end: rule, end: law.ppf(offsets.PAUTA_COVERAGE)},
           bands={"100,000 drawn magnitudes": (0, heights[(10 * r).astype(int)])})  # fmt: skip

# %% [markdown]
# ## A force that isn't Gaussian
#
# REPARE assumes a Gaussian force. But drag grows with the square of the wind ([01 wind and
# rain](01_wind_and_rain.ipynb), where REPARE Eq. 5 has lost the square). If the wind's speed is Gaussian, with a
# standard deviation of $I$ times its mean (the *turbulence intensity*, about 0.3 in a city), the force is skewed: a
# gust of $+I$ adds more than a lull of $-I$ takes away. In units of the mean wind's force,
#
# $$ Q = |V|\,V, \quad V = 1 + I z, \qquad x = \mu + \sigma\,\frac{Q - \operatorname{E}Q}{\sqrt{\operatorname{Var}Q}},
# \tag{9} $$
#
# with $z$ standard normal. $Q$ rises with $V$, so its law is exact: the offset that is exceeded with a chance of
# 0.135 % is the one at $z = 3$. Almost always $V > 0$, and then $Q = V^2$ is noncentral chi-square, with
#
# $$ \operatorname{E}Q = 1 + I^2, \qquad \operatorname{Var} Q = 4I^2 + 2I^4, \qquad
# \text{skewness} = \frac{24 I^4 + 8 I^6}{(4I^2 + 2I^4)^{3/2}} \approx 3I. \tag{10} $$

# %% tags=["nbval-check-output"]
gaussian = OffsetModel(0.0, 1.0)
for intensity in (0.1, 0.2, 0.3, 0.4):
    city = SkewedOffset(0.0, 1.0, intensity)
    ratio = city.beyond(3.0) / gaussian.beyond(3.0)
    print(
        f"I = {intensity}: skewness {city.skewness:.2f}, P(x > μ + 3σ) = {city.beyond(3.0):.4f}, {ratio:.1f} times the "
        f"Gaussian's; 0.135 % is at {city.boundary():.2f}σ"
    )
city = SkewedOffset(0.0, 1.0, 0.3)
drawn = city.sample(1_000_000, 9)
print(f"a million drawn, I = 0.3: skewness {stats.skew(drawn):.2f}, beyond 3σ {np.mean(drawn > 3):.4f}")
assert math.isclose(city.skewness, (24 * 0.3**4 + 8 * 0.3**6) / (4 * 0.3**2 + 2 * 0.3**4) ** 1.5, rel_tol=1e-3)
assert math.isclose(city.beyond(3.0) / gaussian.beyond(3.0), 6.54, abs_tol=0.01)

# %% tags=["figure"]
x = np.linspace(-4, 6, 501)
laws = {"Gaussian": gaussian, "force ∝ |V|V, I = 0.3": city}
reach = "offset downwind x − μ [σ]"
three = {"at 3σ": [(3, 100 * law.beyond(3)) for law in laws.values()]}
same = {"where 0.135 % are beyond": [(law.boundary(), 100 * law.beyond(law.boundary())) for law in laws.values()]}
figure, (left, right) = plot.new_panels(1, 2, width=9.0, height=3.7)
plot.lines(x, {name: law.density(x) for name, law in laws.items()}, reach, "density [1/σ]", places={"3σ": 3}, axes=left)
x = x[x >= 0]
plot.lines(x, {name: 100 * law.beyond(x) for name, law in laws.items()}, reach, "chance of more than x [%]",
           points=three | same, places={"3σ": 3}, log="y", y_range=(1e-3, 100), axes=right)  # fmt: skip

# %% [markdown]
# Same mean, same $\sigma$, and yet downwind the chance beyond $3\sigma$ (discs) is 6.5 times as large; the chance that
# $3\sigma$ has for a Gaussian is reached only at $4.1\sigma$ (triangles). Upwind it is the other way round: a lull can't
# take away more than all the wind, hence the edge on the left. Eq. 9 is the worst case, an offset that follows the
# force at once; a sluggish UAV averages over several gusts, and their sum is nearer to a Gaussian. With samples one can
# look: `SkewedOffset.fit` finds $I$ from their skewness.
#
# ## Over a flight
#
# "0.27 %" is the chance at *one moment*. A flight has many. An offset moves: it is as fast as the UAV's position
# control lets it be. Take that for a critically damped oscillator with the natural frequency $\omega_n$, shaken by
# white noise:
#
# $$ \ddot x + 2\omega_n \dot x + \omega_n^2 x = \text{noise}, \qquad
#    R(\tau) = \sigma^2 (1 + \omega_n|\tau|)\, e^{-\omega_n|\tau|}. \tag{11} $$

# %% tags=["figure"]
time, paths = offsets.offset_paths(1.0, 60.0, 40, count=3, natural_frequency=1.0)
_, rough = offsets.offset_paths(1.0, 60.0, 3, count=1, natural_frequency=1.0, rough=True)
assert paths.shape == (3, 1201)
without = "Ornstein–Uhlenbeck, see below"
flights = {without: rough[0]} | {f"flight {n} (Eq. 11)": path for n, path in enumerate(paths, start=1)}
_, axes = plot.new_figure(7.2, 3.4)
plot.lines(time, flights, "time [s]", "offset towards the wall [σ]", limits={"3σ towards\nthe wall": 3}, axes=axes,
           colors=dict(zip(flights, ("0.75", BLUE, BLACK, PINK), strict=True)))  # fmt: skip

# %% [markdown]
# How often does it cross a level $u$ upwards? In the short time $dt$ those cross that are below it by less than
# $\dot x\,dt$ and move up. Position and speed are independent at any moment, so the rate is
#
# $$ \nu = \int_0^\infty \dot x\; p(u)\, p(\dot x)\, d\dot x = \frac{\sigma_{\dot x}}{2\pi\sigma}\, e^{-u^2/2\sigma^2}
#    = \frac{\omega_n}{2\pi}\, e^{-u^2/2\sigma^2}. \tag{12} $$
#
# This is **Rice's formula**. The last step holds for Eq. 11, where the speed has the standard deviation
# $\sigma_{\dot x} = \sqrt{-R''(0)} = \omega_n\sigma$. From a rate to a chance: with $q = \Phi(u/\sigma)$ the chance not
# to be in the wall at the start, and crossings taken for independent,
#
# $$ P(t) = 1 - q\, e^{-\nu t/q} \;\le\; (1 - q) + \nu t. \tag{13} $$
#
# The bound on the right needs no such assumption. A UAV of 1 m flies along a wall for eight seconds at 3.5 m, with
# $\sigma = 1$ m, so $u = 3.5 - 0.5 = 3\sigma$, and $\omega_n = 1$ rad/s. 160 000 such flights in eight seeds:


# %% tags=["nbval-check-output"]
def collided(step=0.02, rough=False):
    """Share of flights that come nearer than the body allows: its mean over seeds, and half its 95 % interval."""
    flights = [offsets.offset_paths(1.0, 8.0, seed, count=20_000, step=step, rough=rough)[1] for seed in range(8)]
    share = [np.mean(path.max(axis=1) > 3.0) for path in flights]
    return np.mean(share), 2.36 * np.std(share, ddof=1) / math.sqrt(8)  # Student's t, 7 degrees of freedom


predicted = offsets.collision_probability(distance=3.5, sigma=1.0, duration=8.0, uav_diameter=1.0)
measured, half = collided()
print(f"at one moment {gaussian.beyond(3.0):.2%}; over eight seconds Eq. 13: {predicted:.1%}, flown: {measured:.1%}")
assert half < 0.001
assert measured - half < predicted < 1.15 * measured
assert predicted > 11 * gaussian.beyond(3.0)

# %% [markdown]
# Eleven times the chance of a moment, in eight seconds. The formula is a little on the safe side, because crossings
# come in small groups: who has just crossed often crosses again.
#
# It needs an offset that has a speed. A popular model of gusts, the Ornstein–Uhlenbeck process, has none: it is so
# rough that it crosses a level infinitely often. Taken for the *offset*, with the same $\sigma$ and correlation time
# ($2/\omega_n$), it collides two to three times as often, and the finer one looks, the oftener:

# %% tags=["nbval-check-output"]
for step in (0.1, 0.05, 0.02):
    rates = [collided(step, rough)[0] for rough in (False, True)]
    print(f"step {step:.2f} s: second order {rates[0]:.1%}, Ornstein–Uhlenbeck {rates[1]:.1%}")
assert rates[1] > 2.5 * rates[0]

# %% [markdown]
# So the roughness of the model decides as much as its $\sigma$. A UAV has mass and can't jump: the second-order offset
# is the physical one. How large must $k$ be so that not more than 0.27 % of whole *flights* touch the wall?

# %% tags=["nbval-check-output"]
radius = np.linspace(2.0, 7.0, 5001)
durations = {"1 s": 1, "8 s": 8, "1 min": 60, "10 min": 600, "30 min": 1800}
needed = {}
for name, seconds in durations.items():
    chance = offsets.collision_probability(radius, 1.0, seconds)
    needed[name] = radius[np.argmax(chance <= 1 - offsets.PAUTA_COVERAGE)]
    at_three = offsets.collision_probability(3.0, 1.0, seconds)
    print(f"{name:>6} beside a wall: at 3σ {at_three:6.2%} collide; for 0.27 % it takes {needed[name]:.2f}σ")
assert needed["10 min"] > 4.5

# %% tags=["figure"]
seconds = np.geomspace(0.3, 1800, 200)
walls = {f"wall at {k:.3g}σ": k for k in (3.0, offsets.pauta_radius(2), 4.0, 5.0)}
chances = {name: 100 * offsets.collision_probability(k, 1.0, seconds) for name, k in walls.items()}
colors = dict(zip([*chances, "flown, wall at 3σ"], (ORANGE, BLUE, BLACK, PINK, ORANGE), strict=True))
plot.lines(seconds, chances, "time beside the wall [s]", "chance to touch it [%]", log="xy", y_range=(1e-3, 110),
           points={"flown, wall at 3σ": (8, 100 * measured)}, limits={"Pauta: 0.27 %": 0.27},
           places={"8 s": 8, "1 min": 60, "10 min": 600, "30 min": 1800}, colors=colors)  # fmt: skip

# %% [markdown]
# ## What it means for the distance to keep
#
# One $\sigma$ of 1 m, one body of 1 m, and one share, 99.73 %: the distance of Eq. 3 depends on what the share is a
# share of.

# %% tags=["nbval-check-output"]
reaches = {
    "REPARE: one axis, one moment": 3.0,
    "in the plane": offsets.pauta_radius(2),
    "in space": offsets.pauta_radius(3),
    "one axis, force ∝ |V|V, I = 0.3": city.boundary(),
    "one axis, one minute beside a wall": needed["1 min"],
    "one axis, ten minutes beside a wall": needed["10 min"],
}
keep = {name: float(offsets.minimum_safe_distance(k * 1.0, uav_diameter=1.0)) for name, k in reaches.items()}
for name, distance in keep.items():
    print(f"{name:<36} {distance:.2f} m")
assert keep["REPARE: one axis, one moment"] == 3.5
assert sorted(keep.values())[1] > 3.9

# %%
plot.bars(keep, "D_min [m] for 99.73 %, σ = 1 m, body 1 m")

# %% [markdown]
# Which one to take? For a wall at one side, the one axis towards it is right, and the flight is what counts. For a
# volume that must hold the UAV at a given moment in all directions (Fig. 18), the plane or space. What is wrong is to
# call $3\sigma$ "99.7 % safe" without saying of what.
#
# ## Wind towards the wall
#
# A steady wind leaves a mean offset $\boldsymbol\mu$, if the autopilot doesn't take it out. Along a wall with the
# direction $\mathbf n$ pointing away from it the margin changes by $\boldsymbol\mu\cdot\mathbf n$. So the zone has to
# be wider where the wind blows *towards* the wall, and we don't make it narrower where it blows away, since the wind
# may turn:
#
# $$ D_\text{min}(\mathbf x) = k\sigma + \tfrac12 D_\text{uav} + \max(0, -\boldsymbol\mu\cdot\mathbf n). \tag{14} $$

# %% tags=["nbval-check-output"]
wind = np.array([1.0, 0.0])  # mean offset [m], to the east
for side, normal in {"west": (-1, 0), "south": (0, -1), "east": (1, 0)}.items():
    widened = offsets.minimum_safe_distance(3.0, 1.0, mean_offset=wind, normal=normal)
    chances = [
        offsets.collision_probability(d, 1.0, 8.0, uav_diameter=1.0, mean_away=wind @ normal) for d in (3.5, widened)
    ]
    print(f"{side:>5} of a building: at 3.5 m {chances[0]:6.2%}, at D_min = {widened:.1f} m {chances[1]:.2%}")
    assert chances[1] < 0.016

# %% tags=["figure"]
corners = np.array([(6, 3), (-6, 3), (-6, -3), (6, -3)])
quarters = np.radians(np.linspace(np.arange(0, 360, 90), np.arange(90, 450, 90), 61).T)  # around each corner
normal = np.stack([np.cos(quarters), np.sin(quarters)], axis=-1)
zones = {}
for name, mean_offset in {"widened towards the wind (Eq. 14)": (2.0, 0.0), "3.5 m all around": (0.0, 0.0)}.items():
    keep = offsets.minimum_safe_distance(3.0, 1.0, mean_offset=mean_offset, normal=normal)
    outline = (corners[:, None] + keep[..., None] * normal).reshape(-1, 2)
    zones[name] = np.vstack([outline, outline[:1]])
wind = {"mean offset 2 m": [(-13, 8), (-11, 8)]}
plot.diagram("x, east [m]", "y, north [m]", paths=zones, areas={"building": corners}, arrows=wind,
             colors={"building": "0.35"})  # fmt: skip

# %% [markdown]
# ## What the paper says, what we find

# %% tags=["nbval-check-output"]
print(f"Figs 2, 3: 3σ on one axis {offsets.coverage(3, 1):.2%}, in the plane {offsets.coverage(3, 2):.2%}, "
      f"in space {offsets.coverage(3, 3):.2%}")  # fmt: skip
print(f"Fig. 18: 99.73 % needs {joint.circle():.3f}σ; 3σ is {1 - 3 / joint.circle():.1%} too small")
print(f"force ∝ |V|V: {city.beyond(3.0) / gaussian.beyond(3.0):.1f} times the Gaussian's chance beyond 3σ")
print(f"eight seconds at 3.5 m: {predicted:.1%} by Rice, {measured:.1%} flown")
assert (round(float(predicted), 3), round(float(measured), 3)) == (0.015, 0.014)

# %% [markdown]
# | REPARE | says | we find |
# |---|---|---|
# | Eq. 6 | the disturbance is Gaussian | a force $\propto \lvert V\rvert V$ isn't: skewness 0.87 at turbulence 0.3 |
# | | | beyond $3\sigma$ downwind: 6.5 times the chance; 0.135 % is at $4.1\sigma$ |
# | Figs 2, 3 | $3\sigma$ holds 99.7 % | on one axis at one moment, 99.73 % |
# | | | in the plane 98.89 %, in space 97.07 % |
# | Eq. 7 | $D_\text{min} \ge \xi + D_\text{uav}/2$ | right; $\xi = k\sigma$ with $k$ for what is asked |
# | | | $\sigma$ of 1, 4/3, 5/3 m give Table 4's 3.5, 4.5, 5.5 m |
# | Eq. 17 | the probability of two offsets | a density: 4 per m² for $\sigma$ = 0.2 m |
# | | | right for signed axes; a magnitude is Rayleigh, mean $1.2533\sigma$ |
# | Fig. 18 | the safety domain meets the criterion | with $3\sigma$ it is one eighth too small: $3.44\sigma$ |
# | section 3.4 | so the route is safe | eight seconds at $3\sigma$: 1.5 % (Rice), 1.4 % flown |
# | | | ten minutes: 65 %; 0.27 % takes $4.58\sigma$ |
#
# Where does $\sigma$ come from? From the weather: [03 predicting the disturbance](03_predicting_the_disturbance.ipynb).
#
# ## Your turn
#
# Three exercises: how much the plane holds, the distance to keep in the plane with wind, and the filter by hand:
# [exercises/02_pauta_exercises.ipynb](exercises/02_pauta_exercises.ipynb).
