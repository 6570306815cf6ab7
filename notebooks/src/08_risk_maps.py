# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 08 Risk maps: over which places is it dangerous to fly?
#
# A drone (a UAV) may fail, and then it falls on what is below: a lawn full of people, a park, a road. To choose a
# route, a planner needs one number for each place: how many deaths are to be expected per hour of flight above it? Two
# papers compute it in the same way. We follow them from the falling wreck to a map, and on to the deaths that one
# flight is expected to cause. On the way we find a formula in which up to half of the fall's energy is missing, and a
# number without a unit, on which depends which of our two routes is better.
#
# | | |
# |---|---|
# | **You will be able to** | integrate a fall with drag; check a formula by its limits; compute the risk of a place from its people, shelter and cars; compute which way an assumption changes the risk; turn risk per hour into expected deaths per flight |
# | **You need** | chapter [04](04_cities.ipynb) (voxels); derivatives and integrals; nothing of aviation |
# | **Time** | 90 minutes to read, 15 seconds to run |
# | **Paper** | RISK-ACO: Zhang and others, "UAV route planning considering regional risk assessment under complex low altitude environment" (its planner, an ant colony, is chapter 10), section 2, in Chinese ([doi:10.19650/j.cnki.cjsi.J2007192](https://doi.org/10.19650/j.cnki.cjsi.J2007192)). PSO-BAS: Zhang and others, "UAV safe route planning based on PSO-BAS algorithm" (its planner is chapter 11), section 3 ([doi:10.23919/JSEE.2022.000111](https://doi.org/10.23919/JSEE.2022.000111)) |
#
# "Eq. 3" is an equation of this chapter, "RISK-ACO Eq. 7" one of a paper's. Our copies of the papers are texts that a
# program has read from the pages, without the figures.

# %%
import math
from dataclasses import replace

import numpy as np

from uavlab import plot, risk, scene
from uavlab.city import City
from uavlab.planners import least_risk
from uavlab.risk import RiskMap, reference_campus
from uavlab.route import Route
from uavlab.vehicle import RISK_QUADROTOR  # the papers' UAV

# %% [markdown]
# ## The map that we want
#
# The **risk** $r$ of a place is the number of deaths to be expected per hour of flight above it. Flights that
# together spend a million hours there are expected to cause $10^6\,r$ deaths.
#
# Neither text gives its map as numbers. So we invented a *reference campus* of 150 × 150 × 80 m, in voxels of 5 m. It
# was tuned until a planner could meet RISK-ACO's main claim on it (chapter 09): 80 % less risk for 7 % more length,
# against a route that ignores risk. It shows what is possible, not what is usual. `campus.rate` is $r$ in each voxel,
# and `campus.flyable` says where the UAV may fly.

# %%
campus = reference_campus()
level = 27.5  # height of flight above the ground [m], the middle of a layer of voxels

# %% tags=["figure"]
norm = plot.risk_norm(campus)  # one scale of colours for both maps
places = {"square": (130, 133), "lawn": (9, 93), "market": (49, 60), "pitch": (80, 95), "yard": (8, 128),
          "industry": (48, 128), "road": (44, 72), "park": (82, 15)}  # east and north [m]  # fmt: skip


def draw_risk(title, **drawn):
    """Risk of the campus where the UAV may fly at our height."""
    k = campus.city.cell_of((0, 0, level))[2]
    allowed = np.where(campus.flyable[:, :, k], campus.rate[:, :, k], np.nan)
    title = title.format(np.nanmin(allowed), np.nanmax(allowed))
    label = "risk r [deaths per hour of flight]"
    return plot.value_map(campus.city, allowed, label, norm=norm, title=title, **drawn)


draw_risk("Flying over the campus at 27.5 m: r from {:.1e} to {:.1e} per hour",
          notes=places | {"low building": (15, 25), "high building": (47, 13)})  # fmt: skip

# %% [markdown]
# *Black: no flight, as a building there is higher than 24.5 m. The UAV must stay 3 m above what is below it, as in
# PSO-BAS. Roads are 6 m wide. By the centres of their voxels they look 10 m wide in the middle, others 5 m. The bar of colours covers all heights of flight.* The highest risk, over the square, is about 360 times
# the lowest, over the industry. Where do the numbers come from?
#
# A UAV fails $f_c$ times per hour. Over $n_p$ people per m² its wreck hits the people on an area $A_\text{exp}$, and a
# person who is hit dies with the probability $P_\text{die}$. So the people outside of cars contribute
#
# $$ r_\text{people} = f_c\;n_p\;A_\text{exp}\;P_\text{die}. \tag{1} $$
#
# The people in cars come later. Both papers' Table 2 gives $f_c = 6.4\cdot10^{-5}$, one failure in 16 000 hours, and
# $n_p = 0.03$, which is 30 000 people per km². (They call $n_p$ $\rho$; our $\rho$ is the density of air. Our campus has
# 0.03 on average.) Neither text says how $f_c$ was found. All risks are proportional to it, so they are no better than
# that number. The papers' other values, too, stand in Table 2.

# %% tags=["check"]
k = campus.city.cell_of((0, 0, level))[2]
flown = campus.rate[:, :, k][campus.flyable[:, :, k]]
assert round(flown.max() / flown.min(), -1) == 360
assert np.isclose(campus.population_density.mean(), 0.03)
worst, best = (np.unravel_index(pick(np.where(campus.flyable[:, :, k], campus.rate[:, :, k], np.nan)), (30, 30))
               for pick in (np.nanargmax, np.nanargmin))  # fmt: skip
assert min(worst) * 5 >= 112.5  # the square
assert 37.5 < best[0] * 5 < 75  # the industry
assert best[1] * 5 > 112.5
assert round(1 / 6.4e-5, -3) == 16_000

# %% [markdown]
# ## How fast does the wreck fall?
#
# Drag acts against the whole velocity $\mathbf v$ of the wreck. Its strength depends on the *drag area* $R_I A$, the
# drag coefficient $R_I$ (chapter 01 calls it $C_D$) times the area $A$:
#
# $$ \dot{\mathbf v} = \mathbf g - \frac{R_I A\,\rho}{2m}\,|\mathbf v|\,\mathbf v. \tag{2} $$
#
# The papers' UAV has $m = 1.38$ kg, a diameter of 0.4 m, $R_I = 0.3$ and $A = 0.0188$ m². It flies at $v = 16$ m/s, its
# greatest speed. The air has $\rho = 1.225$ kg/m³. We integrate Eq. 2 by hand, in small steps: the velocity gives the
# drag, and the drag the velocity a moment later.

# %%
mass, g, air, papers_drag_area = 1.38, 9.81, 1.225, 0.3 * 0.0188


def fall(height, speed, drag_area=papers_drag_area, dt=0.001):
    """Eq. 2 in small steps: speed forward and down at the end [m/s], and how far ahead that is [m]."""
    forward, down, ahead, fallen = speed, 0.0, 0.0, 0.0
    while fallen < height:
        braking = drag_area * air / (2 * mass) * math.hypot(forward, down)  # per second
        forward, down = forward - braking * forward * dt, down + (g - braking * down) * dt
        ahead, fallen = ahead + forward * dt, fallen + down * dt
    return forward, down, ahead


# %% [markdown]
# The papers simplify: the wreck keeps its forward speed $v$, and drag acts on the fall alone. Then there is a formula.
# Let $h$ be the height that the wreck has fallen through, and $v_z$ its speed downwards. On the next $dh$ the part
# $\tfrac12 m v_z^2$ of its kinetic energy grows by the work of the weight minus that of the drag:
#
# $$ d\bigl(\tfrac12 m v_z^2\bigr) = \bigl(m g - \tfrac12 R_I A\,\rho\,v_z^2\bigr)\,dh
#    \quad\Rightarrow\quad \frac{d(v_z^2)}{dh} = 2g\left(1 - \frac{v_z^2}{v_\infty^2}\right), \qquad
#    v_\infty^2 = \frac{2 m g}{R_I A\,\rho}. \tag{3} $$
#
# At the *terminal speed* $v_\infty$ drag carries the weight. Put $u = 1 - v_z^2/v_\infty^2$. Then
# $du/dh = -(2g/v_\infty^2)\,u$, and $u = 1$ at the beginning. So $u = e^{-2gh/v_\infty^2}$. With
# $2g/v_\infty^2 = R_I A\,\rho/m$ from Eq. 3,
#
# $$ v_z = v_\infty \sqrt{1 - e^{-R_I A\,\rho\,h/m}}. \tag{4} $$
#
# We call Eq. 2 the *full fall* and Eq. 4 the *papers' fall*: the papers simplify in this way, but they print another
# exponent (see below). The map and all that follows use Eq. 4, unless we say otherwise. Without forward speed both
# equations must agree.

# %% tags=["nbval-check-output"]
ways_down = {
    "full fall, by hand": fall(30.0, 16.0)[:2],
    "full fall, library": risk.ballistic_fall(30.0)[2:],  # "ballistic" is its word for the full fall
    "without forward speed, by hand": fall(30.0, 0.0)[:2],
    "papers' fall (Eq. 4), library": (16.0, risk.fall_speed(30.0)),
}
for name, (forward, down) in ways_down.items():
    print(f"{name:<31} {forward:4.1f} m/s forward, {down:4.1f} m/s down")
print(f"terminal speed {risk.terminal_speed():.1f} m/s; the full fall ends {fall(30.0, 16.0)[2]:.0f} m ahead")

# %% tags=["check"]
for height in (5.0, 30.0, 80.0):
    assert np.allclose(fall(height, 16.0)[:2], risk.ballistic_fall(height)[2:], rtol=2e-3)
    assert np.isclose(fall(height, 0.0)[1], risk.fall_speed(height), rtol=2e-3)
    assert np.isclose(fall(height, 16.0)[2], risk.ballistic_fall(height).drift, rtol=3e-3)

# %% [markdown]
# In both texts that we have the exponent of Eq. 4 is $-R_I A\,\rho\,h/(2m)$, with the same $v_\infty$. Which is right?
# A limit tells. For small $x$, $1 - e^{-x} \approx x$, so that for a short fall
#
# $$ v_z^2 \to v_\infty^2\,\frac{R_I A\,\rho\,h}{m} = 2gh \ \text{ (Eq. 4)}, \qquad v_z^2 \to gh \ \text{ (with } 2m\text{)}.
#    \tag{5} $$
#
# Without drag, conservation of energy demands the first. In the second, half of what a short fall gives is missing.
#
# How much does the drag matter? The papers' $R_I A = 0.0056$ m² is small: $A$ is a square of 14 cm, and the UAV is 40
# cm wide. So we also drop a wreck that *tumbles*. A disc as wide as the UAV has 0.126 m² on each face. Seen from all
# directions, a convex body shows on average a quarter of its surface (Cauchy's surface area formula), here half a face.
# A flat body has a drag coefficient of about 1. So we guess $R_I A = 1 \cdot 0.126/2 \approx 0.06$ m².
#
# The wreck hits with the energy $E = \tfrac12 m\,(v^2 + v_z^2)$; in the full fall both speeds are those at its end.

# %% tags=["nbval-check-output"]
tumbling = replace(RISK_QUADROTOR, fall_drag_area=0.06, name="tumbling")  # a copy with another drag area
heights = np.linspace(0.0, 80.0, 801)  # heights[300] is 30 m
full, tumbles = risk.ballistic_fall(heights), risk.ballistic_fall(heights, tumbling)
energies = {
    "papers' fall (Eq. 4)": risk.impact_energy(mass, 16.0, risk.fall_speed(heights)),
    "as printed, with 2m": risk.impact_energy(mass, 16.0, risk.fall_speed(heights, as_printed=True)),
    "full fall": risk.impact_energy(mass, full.forward_speed, full.fall_speed),
    "full fall, tumbling": risk.impact_energy(mass, tumbles.forward_speed, tumbles.fall_speed),
}
for name, energy in energies.items():
    print(f"{name:<21} {energy[300]:.0f} J from 30 m, at least {energy.min():.0f} J from 0 to 80 m")

# %% tags=["figure"]
plot.lines(heights, energies, "height of the fall h [m]", "energy of the impact E [J]", x_range=(0, 80), y_range=(0, 1100),
           places={"30 m": 30.0}, title="How hard the wreck hits after a fall from height h")  # fmt: skip

# %% [markdown]
# *Each point of a curve is the end of another fall. When it tumbles, it at first
# loses more energy forward than it gains downwards.* From 30 m the exponent with $2m$ takes about 180 J from the
# papers' fall, and the larger drag area about 300 J from the full fall.
#
# > **Try it.** A payload of 0.5 kg: does it change the speed, or the energy?

# %% tags=["try-it"]
for wreck in (RISK_QUADROTOR, RISK_QUADROTOR.loaded(0.5)):
    down_now = float(risk.fall_speed(30.0, wreck))
    energy_now = float(risk.impact_energy(wreck.mass + wreck.payload, 16.0, down_now))
    print(f"{wreck.mass + wreck.payload:.2f} kg: {down_now:.1f} m/s down, {energy_now:.0f} J")

# %% [markdown]
# Hardly the speed. The energy grows with the mass.
#
# ## How many people does it hit?
#
# The wreck comes down at an angle. While its underside sinks from the height of a head, $h_p = 1.65$ m, to the ground,
# it flies
# $d = h_p\,v/v_z$ forward. Seen from above, person and wreck are discs. The person is hit if the centres of the two come
# nearer to each other than $R_\text{hit}$, the sum of the radii of a person (0.25 m) and the UAV (0.2 m). So all people
# are hit whose centres lie in a rectangle with a half disc at either end. Its area is
#
# $$ A_\text{exp} = 2\,R_\text{hit}\,d + \pi R_\text{hit}^2, \qquad d = h_p\,\frac{v}{v_z}. \tag{6} $$

# %% tags=["figure"]
down_30, reach, tall = float(risk.fall_speed(30.0)), 0.45, 1.65
glide = tall * 16.0 / down_30
turn = np.radians(np.arange(0, 361, 3))
circle, box = np.column_stack([np.cos(turn), np.sin(turn)]), np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
ends, gap = [(0, 0), (glide, 0)], [(np.nan, np.nan)]
hit = np.concatenate([reach * circle[30:91], np.add(ends[1], -reach * circle[30:91])])
person, flat_box = "a person who is just hit", np.array([(-0.2, 0), (0.2, 0), (0.2, 0.1), (-0.2, 0.1)])
wreck_twice, way = "the wreck, first and last", "way of its underside"
look = {person: plot.ORANGE, wreck_twice: "0.2", way: plot.BLUE}
look["where centres of people are hit"] = plot.SKY
sides = np.array([(0, tall), (glide, 0)])  # middle of the underside

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 2, width=10.0, height=4.7)
flat = np.concatenate([np.add(flat_box, sides[0]), gap, np.add(flat_box, sides[1])])
plot.diagram("along the flight [m]", "height [m]", arrows={way: sides},
             areas={person: (0.5, tall) * box + (glide + 0.2, 0), wreck_twice: flat}, colors=look, axes=panels[0],
             x_range=(-0.6, 2.0), y_range=(-0.2, 2.0), title="The end of a fall from 30 m, from the side")  # fmt: skip
rings = np.concatenate([0.2 * circle, gap, np.add(ends[1], 0.2 * circle)])
plot.diagram("along the flight [m]", "to the side [m]", arrows={way: ends}, axes=panels[1],
             areas={"where centres of people are hit": hit, person: np.add((glide + reach, 0), 0.25 * circle),
                    wreck_twice: rings}, colors=look, x_range=(-0.6, 2.0), y_range=(-1.1, 1.1),
             notes={f"d = {glide:.2f} m": (0.35, 0.05)}, title="From above: people are hit on 1.65 m²")  # fmt: skip
figure

# %% [markdown]
# *The last metres of the papers' fall. The wreck is drawn at head height and on the ground. A person whose feet are
# touched at the last moment counts as hit with the whole energy.* A wreck that falls more slowly, but keeps its forward
# speed, comes in at a flatter angle. So $d$ grows, and it hits more people.
#
# ## Does the blow kill?
#
# *Shelter* $p_s$ says on a scale from 0 to 1 how well people are protected. The papers set it by what stands there: 0
# nothing, 0.25 sparse trees, 0.5 trees or low buildings, 0.75 high buildings, 1 an industrial zone (Table 1 of both).
# They don't say how high is high; on our campus it is more than 20 m. A blow of energy $E$ kills with
#
# $$ P_\text{die} = \frac{1}{1 + \sqrt{E_\alpha/E_\beta}\,\left(E_\beta/E\right)^{1/(4 p_s)}}. \tag{7} $$
#
# In words both papers define $E_\alpha$ (their $\alpha$) as the energy that kills 50 % behind $p_s = \tfrac12$, and
# $E_\beta$ (their $\beta$) as the least energy that kills without shelter. In the texts that we have a brace of the formula is missing, so it isn't clear where the root ends. Put $E = E_\alpha$ and
# $p_s = \tfrac12$. Eq. 7 gives $P_\text{die} = 1/(1 + 1)$, the 50 % of the definition. If the root covered the power, too, it
# would be $1/(1 + (E_\alpha/E_\beta)^{1/4})$, which is 7 %.
#
# The papers give $E_\beta = 34$ J, but no value of $E_\alpha$. Dalamagkidis and others (2012), whose model it is, take
# 1 MJ. So do we, and try a tenth of it below: would half of the people under trees survive a million joules?
#
# Without shelter Eq. 7 divides by zero. Let $p_s \to 0$: the exponent $1/(4p_s)$ grows without bound. If $E > E_\beta$,
# the power of $E_\beta/E < 1$ goes to 0, and $P_\text{die} \to 1$. If $E < E_\beta$, the power goes to infinity, and
# $P_\text{die} \to 0$. So every blow of more than $E_\beta = 34$ J kills, and no weaker one.

# %% tags=["figure"]
energy = np.geomspace(20, 2e6, 901)
chances = {f"{s:g} {name}": np.maximum(risk.impact_fatality(energy, s), 1e-4) for name, s in risk.SHELTER.items()}
marks = {"34 J": 34, "our wreck, 554 J": 554, "1 MJ": 1e6}
half = "1 MJ kills one in two behind 0.5"
plot.lines(energy, chances, "energy of the impact E [J]", "chance to die when hit", places=marks, log="xy",
           points={half: [(1e6, 0.5)]}, x_range=(20, 2e6), y_range=(1e-4, 2), colors={half: "0.3"},
           title="The chance to die, by shelter (10⁻⁴ stands for no chance)")  # fmt: skip

# %% [markdown]
# *The thick line, without shelter, jumps from 0 to 1 at 34 J.* At 554 J, 9 % die behind sparse trees, 2 % behind trees.
# Below 34 J the order is reversed: shelter would do harm. None of our wrecks is that weak, but one on a parachute is
# (exercise 08.1).
#
# ## Deaths per hour: people
#
# Eq. 1 puts the parts together. By hand, with the papers' fall:


# %%
def risk_of_people(height, shelter, people=0.03, failures=6.4e-5):
    """Deaths of people outside of cars per hour of flight, Eqs 1, 4, 6, 7; shelter above 0."""
    terminal = 2 * mass * g / (papers_drag_area * air)  # its square
    down = math.sqrt(terminal * (1 - math.exp(-papers_drag_area * air * height / mass)))
    area = 2 * 0.45 * 1.65 * 16.0 / down + math.pi * 0.45**2
    energy = mass * (16.0**2 + down**2) / 2
    dies = 1 / (1 + math.sqrt(1e6 / 34) * (34 / energy) ** (1 / (4 * shelter)))
    return failures * people * area * dies


by_hand = {shelter: risk_of_people(30.0, shelter) for shelter in (0.25, 0.5, 0.75, 1.0)}

# %% tags=["nbval-check-output"]
print("30 m high, 30 000 people per km²")
rates = {name: float(risk.person_rate(30.0, shelter=shelter)) for name, shelter in risk.SHELTER.items()}
for (name, rate), other in zip(rates.items(), [None, *by_hand.values()], strict=True):
    hand = "" if other is None else f", by hand {other:.2e}"
    print(f"{name:<23} {rate:.2e} deaths per hour of flight{hand}")
print(f"no shelter against industry: {rates['none'] / rates['industry']:.0f} times")
print(f"no shelter, 3 m against 80 m high: {risk.person_rate(3.0) / risk.person_rate(80.0):.1f} times")

# %% tags=["check"]
assert np.allclose(list(by_hand.values()), list(rates.values())[1:], rtol=1e-9)
assert np.isclose(risk.lethal_area(30.0, 16.0, down_30), 1.6525, atol=1e-4)
assert [round(100 * float(risk.impact_fatality(554, s))) for s in (0.25, 0.5)] == [9, 2]
assert [round(float(risk.fall_speed(30.0, as_printed=printed)), 1) for printed in (False, True)] == [23.4, 16.8]
assert (round(math.pi * 0.2**2, 3), round(math.sqrt(0.0188), 2)) == (0.126, 0.14)
assert round(100 / (1 + (1e6 / 34) ** 0.25)) == 7

# %% [markdown]
# ### Which assumptions are on the side of caution?
#
# An assumption is on the *side of caution* if the risk that it gives is probably too high. We replace what we used so
# far, and see by how much $r$ changes. A minus means that our $r$ is the higher one.
#
# > **Predict first.** The drag area of a wreck is probably larger than the papers'. Does a larger one make the risk
# > smaller?

# %%
shelters = np.array(list(risk.SHELTER.values()))
replaced = {
    "full fall": {"ballistic": True},
    "drag area 0.06 m²": {"uav": tumbling},
    "both together": {"uav": tumbling, "ballistic": True},
    "as printed, 2m": {"as_printed": True},
}

# %% tags=["nbval-check-output"]
usual = risk.person_rate(30.0, shelter=shelters)
changes = {}
for name, other in replaced.items():
    changes[name] = risk.person_rate(30.0, shelter=shelters, **other) / usual - 1
easier = risk.impact_fatality(554.0, shelters, even_odds_energy=1e5)  # E_alpha; r is proportional to P_die
changes["Eα = 0.1 MJ"] = easier / risk.impact_fatality(554.0, shelters) - 1
print("change of r, 30 m high,\nbehind shelter   ", *(f"{shelter:7g}" for shelter in shelters))
for name, change in changes.items():
    print(f"{name:<17}", *(f"{one:+7.0%}" for one in change))

# %% [markdown]
# - *The full fall* is nearer to the truth. Its wreck is slower in both directions (14.1 m/s forward), so it hits fewer
#   people, and less hard. So Eq. 4 is on the side of caution; from 3 to 80 m the full fall has 2 to 18 % less risk.
# - *A larger drag area* alone slows down the fall, so the wreck hits more people, but less hard. Without shelter every hit
#   kills anyway, so $r$ grows. Behind sparse trees $P_\text{die}$ is nearly proportional to $E$, so $r$ falls. In the
#   industry it goes nearly with $E^{1/4}$, so $r$ grows. So the papers' small area isn't always on the side of caution. In the full fall it is.
# - *The exponent with $2m$* happens to do the same to the speed: 16.8 m/s down; the larger area makes it 17.1.
# - *$E_\alpha$*: with 0.1 MJ the risk behind shelter is about three times as large. If 1 MJ is too high, as we believe, it isn't on the side of caution.

# %% tags=["check"]
drops_from = np.linspace(3, 80, 78)[:, None]
falls = risk.person_rate(drops_from, shelter=shelters, ballistic=True) / risk.person_rate(drops_from, shelter=shelters)
falls -= 1
assert (round(100 * float(np.min(falls))), round(100 * float(np.max(falls)))) == (-18, -2)
assert round(float(risk.fall_speed(30.0, tumbling)), 1) == 17.1
assert (changes["both together"] < changes["full fall"]).all()
assert 2.6 < (1 + changes["Eα = 0.1 MJ"][1:]).min() < (1 + changes["Eα = 0.1 MJ"]).max() < 3.1
extremes = [
    round(100 * float(end(changes[name]))) for name in ("as printed, 2m", "full fall") for end in (np.min, np.max)
]
assert extremes == [-14, 24, -14, -7]
drops = [energies[a][300] - energies[b][300] for a, b in
         (("papers' fall (Eq. 4)", "as printed, with 2m"), ("full fall", "full fall, tumbling"))]  # fmt: skip
assert [round(float(drop), -1) for drop in drops] == [180, 300]

# %% [markdown]
# ## Deaths per hour: cars
#
# A wreck that falls on a road hits a car with the probability $C_\text{lane}$, the share of a lane that cars cover. Let
# $K$ be the number of cars per length of a lane of width $D_\text{lane} = 3$ m, and $S_\text{car} = 8.4$ m² the ground
# that a car covers. Each car that is hit costs $N_\text{crash} = 3$ lives, from whatever height. The texts don't say
# why so many. (RISK-ACO Eqs 9 and 10, PSO-BAS Eqs 7 and 8. There $C_\text{lane}$, $D_\text{lane}$, $N_\text{crash}$ are
# called $C$,
# $D_\text{road}$, $T$.)
#
# $$ r_\text{cars} = f_c\,C_\text{lane}\,N_\text{crash}, \qquad C_\text{lane} = \frac{S_\text{car}\,K}{D_\text{lane}},
#    \qquad r = r_\text{people} + r_\text{cars}. \tag{8} $$
#
# The papers say "road", but 3 m are one lane. So we let $K$ count the cars of one lane, and $r_\text{cars}$
# is the same over a wide road and a narrow one.
#
# *The unit of K.* Both tables say 0.1, and no unit. Is it per metre or per kilometre?

# %% tags=["nbval-check-output"]
for unit, cars_per_km in {"metre": 100.0, "kilometre": 0.1}.items():
    share = 8.4 * cars_per_km / 1000 / 3.0
    print(f"0.1 per {unit:<9}: cars cover {share:7.3%} of the lane, r = {6.4e-5 * share * 3:.1e} per hour")

# %% [markdown]
# Per metre there is a car every 10 m, a traffic jam. One voxel of road then has more risk than any whole route in the
# papers: their sums of $r$ over all voxels of a route are $8.75\cdot10^{-7}$ (PSO-BAS Table 4) to $2.37\cdot10^{-5}$
# (RISK-ACO Table 5). Yet PSO-BAS says that routes are often over roads. So we take kilometres, a road that is almost
# free of cars. The argument is weak: one voxel of people without shelter ($3.2\cdot10^{-6}$), too, has more than the
# least of these sums. Below we vary $K$.
#
# In Eq. 8 the UAV is a point, which isn't on the side of caution. Its width alone makes the area hit 31 % larger (for a
# car of 4.2 × 2 m, our choice).

# %% tags=["figure"]
levels = np.linspace(3.0, 80.0, 771)
by_shelter = {f"shelter {s:g}, {name}": risk.person_rate(levels, shelter=s) for name, s in risk.SHELTER.items()}
roads = {f"cars alone, {cars:g} per km": float(risk.vehicle_rate(risk.vehicle_share(cars))) for cars in (0.1, 1, 10)}
trees = by_shelter["shelter 0.25, sparse trees"]
lowest = "least over sparse trees"
plot.lines(levels, by_shelter, "height above the ground or the roof below, h [m]", "risk r [deaths per hour]", log="y",
           x_range=(3, 80), y_range=(1e-8, 2e-5), limits=roads, points={lowest: [(levels[trees.argmin()], trees.min())]},
           title="Risk over 30 000 people per km², and over cars")  # fmt: skip

# %% [markdown]
# *People behind five shelters, and cars with nobody outside of them. Dot: sparse trees have least risk at 9 m; at 80 m
# it is 1.7 times as much.* The shelter changes the risk by a factor of up to 86 (printed above, at 30 m), the height
# from 3 to 80 m only by 2.9 or less. Over trees (0.5) $r$ is least at 26 m, without shelter at 80 m (why? see below).

# %% tags=["check"]
assert np.isclose(risk.vehicle_rate(risk.vehicle_share(100.0)), 5.376e-5)
assert round(levels[trees.argmin()]) == 9
assert math.ceil(levels[by_shelter["shelter 0.5, trees or low buildings"].argmin()]) == 26
assert (np.diff(by_shelter["shelter 0, none"]) < 0).all()
assert 3.15e-6 < risk.person_rate(30.0) < 3.25e-6
assert round(trees[-1] / trees.min(), 1) == 1.7
assert 2.85 < max(rates_now.max() / rates_now.min() for rates_now in by_shelter.values()) < 2.9
rounded = 8.4 + 2 * (4.2 + 2.0) * 0.2 + math.pi * 0.2**2
assert round(100 * (rounded / 8.4 - 1)) == 31

# %% [markdown]
# ## The map, and two ways across it
#
# Layers of people, shelter and cars make the map. A place's kind (square, yard, road ...) sets its shelter and how many
# people are there. The people also vary at random from one square of 10 m to the next. We chose all these numbers. Over
# a building (the industry has one, too) $h$ ends at the roof, and $A_\text{exp}$ counts the people as if they stood on
# it. Only the shelter says that they are inside. At one spot of each kind:

# %% tags=["figure"]
spots = {"square": (132, 132), "lawn": (18, 93), "market": (58, 62), "pitch": (88, 98), "yard": (103, 85),
         "industry": (56, 130), "road": (59, 76), "park": (92, 18), "low building": (24, 28),
         "high building": (58, 16)}  # fmt: skip

# %% tags=["nbval-check-output"]
print("                people per km²   shelter   h [m]   r [1/h]")
for name, spot in spots.items():
    i, j, k = campus.city.cell_of((*spot, level))
    people, h = 1e6 * campus.population_density[i, j], campus.city.height_above_surface[i, j, k]
    print(f"{name:<14} {people:15.0f} {campus.shelter[i, j]:9g} {h:7.1f} {campus.rate[i, j, k]:9.1e}")

# %% tags=["check"]
crowd = campus.population_density[worst] / campus.population_density[best]
assert (campus.shelter[worst], campus.shelter[best]) == (0.0, 1.0)
assert (round(float(crowd), 1), round(float(flown.max() / flown.min() / crowd))) == (4.1, 88)

# %% tags=["figure"]
figure = plot.layers(campus)
for axes, title in zip(figure.axes, ("People outside of cars", "Shelter", "Cars"), strict=False):
    axes.set_title(title)
for axes in figure.axes[:2]:
    for name, spot in spots.items():
        text = name.replace(" ", "\n")
        axes.text(*spot, text, size=7, ha="center", va="center", bbox={"fc": "w", "alpha": 0.75, "pad": 0.8, "lw": 0})
figure

# %% [markdown]
# *Names stand at the spots. Of cars, 280 m² per km² are the 0.028 % of above.* And the factor of 360? Its place on the square has 4.1 times as
# many people as that in the industry. The rest, a factor of 88 at 27.5 m, is shelter.
#
# We lay two routes over the campus by hand, both 27.5 m high.

# %%
start, corner, crossing, goal = (12.5, 17.5), (37.5, 37.5), (112.5, 37.5), (112.5, 112.5)
ways = {"straight": [start, goal], "along roads": [start, corner, crossing, goal]}
routes = {name: Route([(*point, level) for point in way]) for name, way in ways.items()}

# %% tags=["figure"]
WAYS = {"straight": plot.BLUE, "along roads": plot.ORANGE}
lengths = ", ".join(f"{route.length:.0f} m {name}" for name, route in routes.items())
lines = {name: np.array(way) for name, way in ways.items()}
draw_risk(f"Two routes at 27.5 m: {lengths}", paths=lines, points={"start": [start], "goal": [goal]}, colors=WAYS,
          notes=places | {"market": (66, 53)})  # fmt: skip

# %% [markdown]
# *The straight route crosses the market (the bright square left of its name) and a corner of the pitch. The other one
# is 32 % longer.*
#
# ### From hours to flights
#
# In an hour the UAV flies $3600\,v$ metres, so a metre takes $1/(3600\,v)$ hours. A flight is expected to cause
#
# $$ F = \int \frac{r}{3600\,v}\,ds \quad\text{deaths per flight}, \tag{9} $$
#
# where $s$ is the length flown in metres. By hand: in steps of 1 cm, each with the risk of the voxel that it is in.


# %%
def deaths_per_flight(risk_map, route, speed=16.0, step=0.01):
    """Expected deaths, Eq. 9, by small steps."""
    deaths = 0.0
    for begin, end in zip(route.points[:-1], route.points[1:], strict=True):
        length = np.linalg.norm(end - begin)
        count = math.ceil(length / step)
        middles = begin + np.outer((np.arange(count) + 0.5) / count, end - begin)
        i, j, k = risk_map.city.cell_of(middles).T
        deaths += risk_map.rate[i, j, k].sum() * length / count / (3600 * speed)
    return deaths


# %% tags=["nbval-check-output"]
without_cars = replace(campus, vehicle_share=0.0)
for name, route in routes.items():
    hand, library = deaths_per_flight(campus, route), campus.fatalities(route)
    in_cars = 1 - without_cars.fatalities(route) / library
    print(f"{name:<11}: by hand {hand:.3e}, library {library:.3e} deaths per flight, {in_cars:.0%} in cars")
both = [campus.fatalities(route) for route in routes.values()]
print(f"straight: one death in {1 / both[0] / 1e6:.0f} million flights, {both[0] / both[1]:.1f} times as many")

# %% tags=["check"]
for route in routes.values():
    assert np.isclose(deaths_per_flight(campus, route), campus.fatalities(route), rtol=1e-3)
    voxels, _ = route.voxels(campus.city)
    assert campus.flyable[tuple(voxels.T)].all()
assert round(routes["along roads"].length / routes["straight"].length, 2) == 1.32

# %% [markdown]
# > **Play.** Two planners answer at once: *least risk* (chapter 09), and *shortest*, which ignores people. The start is
# > over a yard with sparse trees, the goal over a road (other places than above). Move each from 7.5 to 77.5 m (Page Up
# > and Down; the camera *side* has room for that). Over which does $r$ grow? What could be the reason?

# %%
yard, road = (47.5, 47.5, level), (112.5, 112.5, level)
scene.live(campus.city, yard, road, risk=campus, planners=["least risk", "shortest"])

# %% [markdown]
# *The scene at first. Least risk is 61 % longer than shortest, but causes a tenth of the deaths.*
#
# <details><summary>The answer</summary>
#
# Over the yard $r$ grows from $2.6\cdot10^{-7}$ to $4.3\cdot10^{-7}$ per hour, over the road it falls from
# $1.1\cdot10^{-6}$ to $5.6\cdot10^{-7}$. From higher up the wreck falls more steeply: it hits fewer people, but harder.
# Behind trees the harder blow counts more. Without shelter every hit kills anyway.
#
# </details>

# %% tags=["check"]
from_below = {
    name: campus.rate[tuple(campus.city.cell_of(place)[:2])][1:] for name, place in {"yard": yard, "road": road}.items()
}
assert (np.diff(from_below["yard"]) > 0).all()
assert (np.diff(from_below["road"]) < 0).all()
assert [f"{r:.1e}" for r in from_below["yard"][[0, -1]]] == ["2.6e-07", "4.3e-07"]
assert [f"{r:.1e}" for r in from_below["road"][[0, -1]]] == ["1.1e-06", "5.6e-07"]
i, j, _ = campus.city.cell_of(yard)
assert campus.shelter[i, j] == 0.25
safest = least_risk(campus, yard, road)
shortest = least_risk(campus, yard, road, risk_weight=0.0, length_weight=1.0)
assert round(safest.length / shortest.length, 2) == 1.61
assert round(campus.fatalities(shortest) / campus.fatalities(safest)) == 10

# %% [markdown]
# ### Where does the wreck land?
#
# Map and $F$ count the people straight below the place where the UAV fails, as the papers do. But the wreck flies far
# ahead, in Eq. 4 (38 m) as in the full fall:

# %% tags=["nbval-check-output"]
for name, area in {"papers' drag area": papers_drag_area, "tumbling, 0.06 m²": 0.06}.items():
    ahead = fall(level, 16.0, area)[2]
    print(f"full fall, {name}: {ahead:.0f} m ahead, {ahead / 5:.1f} voxels")
for name, route in routes.items():  # F with the people where the full fall ends (papers' drag area)
    more = campus.integral(route, drift=True) / campus.integral(route)
    print(f"{name:<11}: F = {more * campus.fatalities(route):.1e} where the wreck lands, {more:.1f} times as much")

# %% tags=["check"]
speed_limit = risk.terminal_speed()
seconds = speed_limit / g * math.acosh(math.exp(g * level / speed_limit**2))  # of Eq. 4, v = v_inf tanh(g t / v_inf)
assert round(16.0 * seconds) == 38
landed = [campus.integral(route, drift=True) for route in routes.values()]
assert round(landed[0] / landed[1], 1) == 2.4

# %% [markdown]
# Hardly a place on this campus is as wide as that. If the UAV fails over the market, the wreck lands on what comes next
# on the route. So $r$ says where a wreck that comes down does most harm, not where it is most dangerous to fail. Our
# two routes keep their order: the straight one has 2.4 times the deaths of the other, instead of 2.7. More in chapter
# [09](09_route_of_least_risk.ipynb); here we stay with the papers.
#
# ### How many cars?
#
# The roads win, with 0.1 cars per kilometre.
#
# > **Predict first.** From how many cars per kilometre on is the straight route better? Would that be a busy road?

# %%
cars = np.geomspace(0.05, 200.0, 200)  # cars per km of a lane
people = {name: without_cars.fatalities(route) for name, route in routes.items()}
per_car = {name: (campus.fatalities(route) - people[name]) / 0.1 for name, route in routes.items()}
deaths = {name: people[name] + per_car[name] * cars for name in routes}  # F is linear in the cars
equal_at = (people["straight"] - people["along roads"]) / (per_car["along roads"] - per_car["straight"])

# %% tags=["figure"]
label = f"equal at {equal_at:.1f} cars per km"
plot.lines(cars, deaths, "cars per km of a lane", "deaths per flight F", log="xy", x_range=(0.05, 200),
           points={label: [(equal_at, people["straight"] + per_car["straight"] * equal_at)]}, colors=WAYS | {label: "0.2"},
           places={"0.1 per km": 0.1, "0.1 per m": 100.0}, y_range=(1e-9, 1e-6),
           title="Deaths per flight on the two routes over the campus, 27.5 m high")  # fmt: skip

# %% [markdown]
# *The dot is where the better route changes.* From 2.4 cars per kilometre on, the straight one is better. At 50 km/h
# that is a car every 30 seconds on each lane: a quiet road. The two readings of $K = 0.1$ lie on either side. So, with
# all else as it is here, the missing unit decides which of these two routes is better.

# %% tags=["check"]
for number in (0.1, 10.0):
    busy = replace(campus, vehicle_share=campus.vehicle_share * number / 0.1)
    for name, route in routes.items():
        assert np.isclose(busy.fatalities(route), people[name] + per_car[name] * number)
assert round(equal_at, 1) == 2.4
assert round(3600 / (2.4 * 50)) == 30

# %% [markdown]
# ### Sums and integrals
#
# The papers add up $r$ over the voxels that a route passes, each voxel once (RISK-ACO Eq. 3, PSO-BAS Eq. 1). On a map
# with the same risk everywhere we fly the diagonal of 10 × 10 voxels, from centre to centre.
#
# > **Predict first.** The diagonal passes 10 voxels. We shift it to the east by 1 m. How many are they now?

# %%
uniform_map = RiskMap(City(np.zeros((10, 10, 10), dtype=bool), cell=5.0), 0.03, shelter=0.5)
diagonals = {shift: Route([(2.5 + shift, 2.5, 27.5), (47.5 + shift, 47.5, 27.5)]) for shift in (0.0, 1.0)}

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 2, width=9.6, height=4.8)
for axes, (shift, route) in zip(panels, diagonals.items(), strict=True):
    index, length = route.voxels(uniform_map.city)
    passed = np.zeros(uniform_map.city.shape[:2], dtype=bool)
    passed[tuple(index[length > 1e-9][:, :2].T)] = True
    sums, same = uniform_map.cell_sum(route), uniform_map.fatalities(route)
    plot.area_map(uniform_map.city, {"voxels in the sum": passed}, paths={"route": route.points[:, :2]}, axes=axes,
                  colors={"voxels in the sum": plot.SKY, "route": plot.ORANGE},
                  title=f"Shifted by {shift:.0f} m: {passed.sum()} voxels,\n"
                        f"sum of r {sums:.1e} per hour,\nF = {same:.2e} deaths per flight")  # fmt: skip
plot.finished(figure)

# %% [markdown]
# *The same route twice, over 30 000 people per km² behind $p_s = \tfrac12$.* The papers' sum almost doubles, even for a
# shift by a millimetre, and nothing has changed for anybody on the ground. Also, the diagonal through the corners adds
# as many voxels as a straight way of 45 m, though it is $\sqrt2$ times as long. $F$ has neither fault. The sum also
# depends on the size of the voxels. Our two routes again:

# %% tags=["nbval-check-output"]
for cell in (5.0, 1.0):
    finer = reference_campus(cell)
    for name, route in routes.items():
        sums, one = finer.cell_sum(route), finer.fatalities(route)  # the papers' sum, and F
        print(f"voxels of {cell:g} m, {name:<11}: sum {sums:.1e} per hour, F = {one:.2e} deaths per flight")

# %% tags=["check"]
for route in routes.values():
    assert 3.0 < campus.cell_sum(routes["straight"]) / 2.37e-5 < 3.2
    assert finer.cell_sum(route) > 4 * campus.cell_sum(route)
    assert abs(finer.fatalities(route) / campus.fatalities(route) - 1) < 0.04
    assert np.isclose(campus.integral(route), 3600 * 16.0 / 5.0 * campus.fatalities(route))
nudged = Route([(2.501, 2.5, 27.5), (47.501, 47.5, 27.5)])
assert np.isclose(uniform_map.cell_sum(nudged), 1.9 * uniform_map.cell_sum(diagonals[0.0]))
assert np.isclose(uniform_map.fatalities(nudged), uniform_map.fatalities(diagonals[0.0]))

# %% [markdown]
# From 5 m to 1 m the sums grow to more than four times. $F$ changes by less than 4 %, because small voxels follow the
# edges of the places more closely. In the next chapters planners minimise the *cost*
#
# $$ C = \frac{1}{\Delta x}\int r\,ds = \frac{3600\,v}{\Delta x}\,F \tag{10} $$
#
# with the edge $\Delta x$ of a voxel (`campus.integral`). $C$ has the unit of the papers' sums. On one map, at one
# speed, it is $F$ times a constant, so the same routes win. To say how dangerous a flight is, quote $F$.
#
# > **Try it.** Let the UAV fly at 8 m/s. How does $F$ change? (The map keeps the risk of a wreck at 16 m/s.)

# %% tags=["try-it"]
for slow_name, slow_route in routes.items():
    print(f"{slow_name}: {campus.fatalities(slow_route, speed=8.0):.2e} deaths per flight")

# %% [markdown]
# Twice as many: it is over each place for twice as long. But a wreck at 8 m/s forward also hits fewer people, and less
# hard. Exercise 08.5 asks which effect wins.
#
# ## Remember
#
# - The risk $r$ of a place is in deaths per hour of flight: failures per hour times people per area, area hit, and
#   chance to die, plus the part of the cars.
# - Check a formula by its limits. A short fall must have $v_z^2 \to 2gh$; with $2m$ in the exponent it has $gh$.
# - A wreck that falls more slowly hits less hard. If it keeps its forward speed, it hits more people. Which effect wins
#   depends on the shelter: what is on the side of caution has to be computed.
# - Shelter changes the risk by a factor of up to 86 (from 30 m), the height by at most 2.9 (3 to 80 m).
# - A flight is expected to cause $F = \int r\,ds/(3600\,v)$ deaths. A sum over voxels depends on where their edges lie.
# - Map and $F$ let the wreck land straight below. In the full fall from 27.5 m it lands 27 m (tumbling) or 37 m ahead.
#
# ## What the paper says, what we find
#
# | RISK-ACO; PSO-BAS (their equations) | say | we find |
# |---|---|---|
# | Eq. 7; Eq. 5: fall | exponent $-R_I A\,\rho\,h/(2m)$ | $-R_I A\,\rho\,h/m$: 23.4 m/s after 30 m, not 16.8. With $2m$ in it, $r$ changes by −14 to +24 % (30 m) |
# | Eq. 7; Eq. 5 | drag on the fall alone | with drag on the whole velocity $r$ is 7 to 14 % less (30 m) |
# | Table 2 of both | $R_I A = 0.0056$ m² | with 0.06 m² $r$ without shelter is 22 % more; with 0.06 m² in the full fall it is 35 % less (30 m) |
# | Eq. 8; Eq. 6: chance to die | $\alpha$ has no value; undefined at $p_s = 0$ | 1 MJ from the model's source; a step at 34 J. Below 34 J shelter does harm |
# | Eq. 8; Eq. 6 | in the texts that we have a brace is missing, so the root has no end | the root covers $E_\alpha/E_\beta$ alone. Over the power, too, $E_\alpha$ would kill 7 % instead of one in two behind $p_s = \tfrac12$ |
# | Table 2 of both | $K = 0.1$, no unit | per metre one voxel of road has more risk than any of their routes. At 2.4 cars per km and lane the better of our two routes changes |
# | Eq. 3; Eq. 1: cost | $\sum r$ over voxels | depends on the grid: a shift by a millimetre makes 19 voxels of 10 |
# | both | the wreck lands straight below | 27 to 37 m ahead from 27.5 m, in the full fall; $F$ of our routes is then 1.6 and 1.7 times as large |
#
# ## Read on
#
# - K. Dalamagkidis, K. P. Valavanis, L. A. Piegl, *On Integrating Unmanned Aircraft Systems into the National Airspace
#   System*, 2nd edition, Springer 2012, ISBN 978-94-007-2478-5: the model of Eqs 1 and 7, and its values.
# - X. Zhang, Y. Liu, Y. Zhang and others, "Safety assessment and risk estimation for unmanned aerial vehicles operating
#   in national airspace system", *Journal of Advanced Transportation* 2018,
#   [doi:10.1155/2018/4731585](https://doi.org/10.1155/2018/4731585): the source that both papers name for the area hit.
# - A. Washington, R. Clothier, J. Silva, "A review of unmanned aircraft system ground risk models", *Progress in
#   Aerospace Sciences* 95 (2017) 24–44,
#   [doi:10.1016/j.paerosci.2017.10.001](https://doi.org/10.1016/j.paerosci.2017.10.001): other models of each factor.
#
# ## Your turn
#
# Six exercises: a parachute, the cars of a whole road, the chance to die, the deaths of a route, the best speed, and a
# pair of routes that fools the papers' sum:
# [exercises/08_risk_maps_exercises.ipynb](exercises/08_risk_maps_exercises.ipynb).
#
# Before: [07 REPARE](07_repare.ipynb). Next: [09 The route of least risk](09_route_of_least_risk.ipynb).
