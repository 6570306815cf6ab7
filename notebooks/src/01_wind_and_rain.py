# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 01 Wind and rain: which weather grounds which load?
#
# A small quadrotor stands ready with a parcel. It rains, and the wind comes in gusts. May it take off? How hard do rain
# and wind push, and how much thrust is left against both? From the answers we draw a map of all loads and winds in
# which the quadrotor may fly, its *flight envelope*.
#
# The paper of the route planner REPARE ("Route Planning Algorithm of Resilience Enhancement") prints five formulas for
# it. We build each force ourselves and compare at the end.
#
# | | |
# |---|---|
# | **You will be able to** | compute the force of rain and the drag of wind; find the ground speed that a wind leaves on a course; draw a flight envelope and say which assumptions it hangs on; read a spectrum of gusts and test gusts against it |
# | **You need** | Newton's second law, vectors, integrals, standard deviation, what a Fourier transform does; NumPy; nothing of aviation |
# | **Time** | 75 minutes to read, 20 seconds to run |
# | **Paper** | REPARE: Xu and others, *Sensors* 22 (2022) 2151, section 2.2.1, Eqs 1–5 ([doi:10.3390/s22062151](https://doi.org/10.3390/s22062151)) |
#
# "Eq. (3)" is an equation of this chapter, "REPARE Eq. 3" one of the paper.

# %%
import numpy as np

from uavlab import plot
from uavlab.vehicle import DATA_SHEETS, GRAVITY, LIGHT_QUADROTOR
from uavlab.weather import (
    air_density,
    greensboro_weather,
    lift_margin,
    rain_force,
    reachable_ground_speed,
    reference_wind,
    wind_drag,
    wind_limit,
)

uav = LIGHT_QUADROTOR

# %% [markdown]
# ## The vehicle
#
# REPARE speaks of "a civil light quadrotor UAV" (UAV: unmanned aerial vehicle) with light, moderate and heavy loads. It
# gives no figures. So all figures here are our choice:
#
# | quantity | symbol | value | why |
# |---|---|---|---|
# | mass without load | | 1.5 kg | DJI's Phantom 4 and Matrice 100 have 1.4 and 2.4 kg |
# | loads: light, moderate, heavy | | 0.25, 0.6, 1 kg | up to two thirds of the UAV's own mass |
# | greatest thrust of all rotors | $T$ | 28 N | almost twice the weight without load |
# | drag area (explained below) | $C_D A$ | 0.06 m² | that of a square of 24 cm with $C_D = 1$; ours, a guess |
# | area that rain falls on | $A_r$ | 0.1 m² | a square of 32 cm for body, arms and battery; a guess |
# | ground speed that is asked for | $V_d$ | 5 m/s | a careful speed between houses |
# | greatest steady speed through the air | $V_\text{uav}$ | 18 m/s | a little below the 20 to 22 m/s in the data sheets of Phantom 4, Matrice 100 and Mavic 2 Pro |
#
# They are plausible, not measured. In chapter [07](07_repare.ipynb) they give, with one fitted constant, the distances
# from walls that REPARE prints as safe.

# %% tags=["check"]
assert (uav.mass, uav.thrust, uav.drag_area, uav.rain_area, uav.top_speed) == (1.5, 28.0, 0.06, 0.1, 18.0)
assert uav.cruise_speed == 5
assert 1.9 < uav.thrust / uav.weight < 2.0
assert [sheet.top_speed for sheet in DATA_SHEETS] == [20.0, 22.0, 20.0]
assert [round(sheet.mass, 1) for sheet in DATA_SHEETS[:2]] == [1.4, 2.4]
assert round(np.sqrt(uav.rain_area), 2) == 0.32
assert 0.24 < np.sqrt(uav.drag_area) < 0.25

# %% [markdown]
# ## Four forces
#
# Let the UAV hover (stand still over the ground) in a wind of 10 m/s from the west. Four forces act on the UAV: its
# weight $m g$ (with $m$ its mass and load, and $g = 9.81$ m/s²), the force $F_r$ of the rain, the drag $F_w$ of the
# wind, and the thrust $F_T$ of the rotors, which is at most $T$. Nothing accelerates, so the four add up to zero.
#
# The thrust always points along the axis of the rotors. To push against the wind, the UAV has to tilt into it. With a
# tilt $\varphi$, the thrust has a vertical and a horizontal part:
#
# $$ F_T \cos\varphi = m g + F_r, \qquad F_T \sin\varphi = F_w
#    \quad\Longrightarrow\quad \tan\varphi = \frac{F_w}{m g + F_r}. \tag{1} $$


# %% tags=["figure"]
def draw_forces(axes, vehicle, drag, title, rain=0.0, limit=False):
    """Free-body diagram in newtons: the thrust balances weight, rain and drag."""
    down = vehicle.weight + rain
    tips = {"weight": (0, -vehicle.weight), "drag of the wind": (drag, 0), "thrust": (-drag, down)}
    arrows = {name: [(0, 0), tip] for name, tip in tips.items()}
    notes = {f"{np.hypot(*tip):.1f} N": tip for tip in tips.values()}
    arm = 2.2 * np.array([down, drag]) / np.hypot(down, drag)
    if rain:
        onto = np.array([1.2, 0.2 + 1.2 * drag / down])
        arrows["rain (not to scale)"] = [onto + np.array([0, 2.5]), onto]
    paths = {"UAV (not to scale)": [-arm, arm]}
    if limit:
        angle = np.radians(np.linspace(0, 180, 91))
        paths["greatest thrust, 28 N"] = vehicle.thrust * np.array([np.cos(angle), np.sin(angle)]).T
    return plot.diagram("force to the east [N]", "force upwards [N]", paths=paths, arrows=arrows, notes=notes, axes=axes,
                        title=title, colors=FORCES, x_range=None if limit else (-14, 14))  # fmt: skip


# %% tags=["figure"]
FORCES = {"weight": plot.BLACK, "drag of the wind": plot.ORANGE, "thrust": plot.BLUE, "greatest thrust, 28 N": plot.PINK,
          "rain (not to scale)": plot.SKY, "UAV (not to scale)": plot.GREEN}  # fmt: skip
figure, axes = plot.new_figure(6.4, 5.4)
push = wind_drag((10, 0), (0, 0), uav.drag_area)[0]
draw_forces(
    axes, uav, push, "Hovering without load, 10 m/s from the west, 100 mm/h", rain=rain_force(100, uav.rain_area)
)

# %% tags=["check"]
assert round(float(push), 1) == 3.7
assert round(np.degrees(np.arctan2(push, uav.weight))) == 14

# %% [markdown]
# *The forces on a UAV that hovers without load.* The wind pushes with 3.7 N (section *Drag* says why). The UAV tilts by
# 14° to the west, and its thrust balances drag, weight and rain.
#
# ## Rain
#
# Rain is measured as a depth $H$ of water that falls in a time $t$. In one second the area $A_r$ receives the volume
# $A_r H/t$ of water. With the density of water $\rho_\text{water} = 1000$ kg/m³ this is a mass of
# $\rho_\text{water} A_r H/t$. The drops arrive with their fall speed $V_r$. If they stick, they lose all of it. If they
# bounce back with a share $\varepsilon$ of their speed (the *restitution*), their speed changes by
# $(1 + \varepsilon) V_r$. A force is a change of momentum per second, so
#
# $$ F_r = \rho_\text{water}\, \frac{H}{t}\, A_r\, V_r\, (1 + \varepsilon). \tag{2} $$
#
# Large drops of 5 mm fall with 9 m/s (Gunn and Kinzer), smaller ones are slower. We take 9 m/s and $\varepsilon = 0$.
# If drops bounce, the force is larger, but never more than twice ours.
#
# > **Predict first.** A cloudburst brings 100 mm in an hour. Our UAV has 0.1 m² for it to fall on. How heavy a load
# > presses as hard as this rain: 2.5 g, 25 g or 250 g?

# %% tags=["nbval-check-output"]
cloudburst = rain_force(100, uav.rain_area)
print(f"100 mm/h press with {cloudburst:.3f} N, the weight of {1000 * cloudburst / GRAVITY:.1f} g")
for share, does in ((0.0, "stick"), (1.0, "bounce back with all of their speed")):
    metres = 0.25 * GRAVITY / rain_force(1000, uav.rain_area, restitution=share)
    print(f"as heavy as 0.25 kg: {metres:.1f} m of rain in an hour, if drops {does}")

# %% tags=["check"]
assert np.isclose(cloudburst, 0.025)
assert round(float(1000 * cloudburst / GRAVITY), 1) == 2.5
assert rain_force(100, uav.rain_area, as_printed=True) == 0
assert 4.9 < metres < 4.91
assert 16 < metres / 0.305 < 16.2
assert 39 < 0.1 / (cloudburst / GRAVITY) < 41

# %% [markdown]
# **2.5 g.** Rain that presses like our lightest load, 0.25 kg, would bring at least 4.9 m in an hour. The [most ever
# measured](http://wmo.asu.edu/world-greatest-sixty-minute-one-hour-rainfall) in an hour is 0.305 m (Holt, Missouri,
# 1947). So the force of rain is a matter of grams. Water that *stays* matters more: a film of one millimetre on 0.1 m²
# weighs 100 g.
#
# > **Try it.** Hail melts to 100 mm/h. Say that it falls with 20 m/s and bounces back with half of its speed. How hard
# > does it press?

# %% tags=["try-it"]
hail = rain_force(100, uav.rain_area, drop_speed=20.0, restitution=0.5)
print(f"{hail:.3f} N, the weight of {1000 * hail / GRAVITY:.1f} g")

# %% [markdown]
# ## Lift
#
# The thrust has to carry the weight of the UAV with its load, and the rain. A safety factor $\delta$ above 1 keeps
# something in hand for climbing and steering. What is left in calm air is the **lift margin**
#
# $$ M = T - \delta\,(m g + F_r), \tag{3} $$
#
# and the UAV may take off where $M > 0$. The paper gives no number for its safety factor.

# %% tags=["nbval-check-output"]
for payload in (0.0, 0.6, 1.0, 1.1):
    loaded = uav.loaded(payload)
    dry, wet = lift_margin(loaded), lift_margin(loaded, cloudburst)
    print(f"load {payload:.2f} kg, δ = 1.1: M = {dry:6.3f} N when dry, {wet:6.3f} N in 100 mm/h")
for factor in (1.0, 1.1, 1.2, 1.5):
    print(f"δ = {factor}: at most {uav.thrust / (factor * GRAVITY) - uav.mass:.3f} kg of load")

# %% tags=["check"]
heaviest = uav.thrust / (1.1 * GRAVITY) - uav.mass
assert np.isclose(lift_margin(loaded, cloudburst, as_printed=True) - wet, 0.0025)
assert round(heaviest, 3) == 1.095
assert lift_margin(uav.loaded(heaviest - 1e-9)) > 0 > lift_margin(uav.loaded(heaviest + 1e-9))
assert round(uav.thrust / uav.loaded(1.0).weight, 2) == 1.14

# %% [markdown]
# We take $\delta = 1.1$, because we want our heavy load, 1 kg, to fly. With $\delta = 1.2$ it would be grounded in
# every weather.
#
# ## Drag
#
# Air of the density $\rho$ that comes with the speed $V_\text{rel}$ brings the mass $\rho A V_\text{rel}$ to an area
# $A$ each second. Each kilogram of it carries the momentum $V_\text{rel}$. If the body took all of it, the force would
# be $\rho A V_\text{rel}^2$. But some air flows around the body. So engineers write
# $\frac12 C_D\, \rho A V_\text{rel}^2$ and measure the *drag coefficient* $C_D$ in a wind tunnel. We only need the
# product $C_D A$, the *drag area*. For the density we take $\rho = 1.225$ kg/m³, the "standard air" of aviation (dry,
# 15 °C, 1013.25 hPa).
#
# What counts is the speed of the air as seen from the UAV. With the wind $\mathbf W$ (where the air moves to, over
# ground) and the velocity $\mathbf v$ of the UAV over ground,
#
# $$ \mathbf F_w = \tfrac12\, \rho\, C_D A\, |\mathbf V_\text{rel}|\, \mathbf V_\text{rel},
#    \qquad \mathbf V_\text{rel} = \mathbf W - \mathbf v. \tag{4} $$

# %%
half = 0.5 * 1.225 * uav.drag_area


def drag(wind, velocity):
    """Eq. (4): force of the air [N] along each axis."""
    relative = np.subtract(wind, velocity)
    return half * np.linalg.norm(relative) * relative


# %% [markdown]
# > **Predict first.** The UAV flies to the east with 10 m/s. Sort the drag by size: calm air; a wind of 10 m/s from
# > behind; a wind of 10 m/s from ahead. And what if it hovers in that wind?

# %% tags=["nbval-check-output"]
for wind, velocity in ((0, 10), (10, 10), (-10, 10), (-10, 0)):
    force = drag((wind, 0), (velocity, 0))[0]
    print(f"wind {wind:3d} m/s, UAV {velocity:2d} m/s to the east: drag {force + 0:6.1f} N to the east")

# %% tags=["check"]
for wind, velocity in (((0, 0), (10, 0)), ((-10, 3), (10, -1)), ((4, 4), (4, 4))):
    assert np.allclose(drag(wind, velocity), wind_drag(wind, velocity, uav.drag_area))
assert np.isclose(drag((-10, 0), (10, 0))[0], 4 * drag((-10, 0), (0, 0))[0])
assert round(drag((0, 0), (10, 0))[0], 1) == -3.7
assert round(wind_drag((0, 0), (10, 0), uav.drag_area, as_printed=True)[0], 2) == 0.37  # kg/s, and forwards
assert wind_drag((10, 0), (0, 0), uav.drag_area, as_printed=True)[0] == 0

# %% [markdown]
# With the wind from behind there is no drag at all: the UAV drifts along with the air. From ahead the air is twice as
# fast as in calm air, and the drag is **four times** as large. Hovering in that wind is as hard as flying in calm air.
#
# ## Which wind counts?
#
# REPARE takes the larger of two mean winds: the one that is forecast and the one that the UAV measures. We call it $W$.
# (The paper doesn't say over which time it averages. Meteorologists take ten minutes; see exercise 01.5.) But a *gust*,
# the strongest wind in those minutes (often averaged over 3 s), is what pushes a UAV into a wall. So beside $W$ we need
#
# $$ W_\text{gust} = \max(\text{strongest wind of the forecast},\ G\, W). \tag{5} $$
#
# The *gust factor* $G$ comes from Eurocode 1, made for buildings. It starts from the *turbulence intensity*
# $I_u = \sigma_u/W$, the standard deviation of the wind speed over its mean. It depends on the height $z$ and on a
# *roughness length* $z_0$, which the Eurocode lists for each kind of ground: $I_u = 1/\ln(z/z_0)$. The Eurocode sets
# the strongest gust $3.5\,\sigma_u$ above the mean. Pressure goes with the square of speed. So the gust's pressure is
# that of the mean wind times $(1 + 3.5\, I_u)^2 = 1 + 7 I_u + 12.25\, I_u^2$. The Eurocode keeps the first two terms.
# Their root is the factor of speed:
#
# $$ G = \sqrt{1 + 7 I_u}. \tag{6} $$


# %% tags=["nbval-check-output"]
def gust_factor(height, roughness):
    """Eq. (6): strongest gust over the ten-minute mean."""
    return np.sqrt(1 + 7 / np.log(height / roughness))


for roughness, ground in ((0.003, "open sea"), (0.05, "grass"), (0.3, "suburb"), (1.0, "city")):
    low, high = gust_factor(30.0, roughness), gust_factor(60.0, roughness)
    whole = 1 + 3.5 / np.log(30.0 / roughness)
    print(f"{ground:<8}  z0 = {roughness:5.3f} m: G = {low:.2f} at 30 m", end=" ")
    print(f"({whole:.2f} with all terms), {high:.2f} at 60 m")

# %% tags=["check"]
assert round(gust_factor(30.0, 1.0), 2) == 1.75
assert round(1 + 3.5 / np.log(30.0), 2) == 2.03
assert [round(1.75**2, 2), round((1 + 3.5 / np.log(30.0)) ** 2, 1)] == [3.06, 4.1]
assert [round(gust_factor(height, 0.05), 2) for height in (10.0, 60.0)] == [1.52, 1.41]
assert reference_wind(6, 5) == (6, 10.5)
assert reference_wind(6, 8, 12) == (8, 14)
assert reference_wind(6, 5, 12) == (6, 12)

# %% [markdown]
# We keep to the standard and take its $G = 1.75$ for 30 m above a city. In force this is a factor of $1.75^2 = 3.06$.
# With the term that the Eurocode leaves out, it would be 4.1, with $G = 2.03$.
#
# ## The wind triangle
#
# A *course* is a direction over ground. The UAV chooses its velocity through the air, $\mathbf V_\text{air}$, at most
# $V_\text{uav}$ fast. The wind carries it along, so $\mathbf v = \mathbf V_\text{air} + \mathbf W$. To stay on the
# course, $\mathbf V_\text{air}$ has to cancel the part $W_\perp$ of the wind that blows across the course. Of the air
# speed, $\sqrt{V_\text{uav}^2 - W_\perp^2}$ is left along the course, by Pythagoras. The wind adds its part
# $W_\parallel$ along the course, which is positive from behind and negative from ahead. At least the ground speed $V_d$
# is asked for:
#
# $$ v = \sqrt{V_\text{uav}^2 - W_\perp^2} + W_\parallel \ \ge\ V_d. \tag{7} $$

# %% tags=["figure"]
wind, course = np.array([-3.0, -8.0]), np.array([1.0, 0.0])
ground = reachable_ground_speed(uav.top_speed, wind, course) * course
through_air = ground - wind
triangle = {
    f"velocity through the air, {np.linalg.norm(through_air):.0f} m/s": ((0, 0), through_air),
    f"wind, {np.linalg.norm(wind):.1f} m/s": (through_air, ground),
    f"velocity over ground, {np.linalg.norm(ground):.1f} m/s, on the course": ((0, 0), ground),
}
plot.diagram(
    "east [m/s]", "north [m/s]", arrows=triangle, title="A course to the east in a wind from the north-north-east"
)

# %% tags=["check"]
assert np.isclose(np.linalg.norm(through_air), uav.top_speed)
assert np.isclose(ground[0], np.sqrt(18**2 - 8**2) - 3)

# %% [markdown]
# *The wind triangle for a wind of 3 m/s to the west and 8 m/s to the south.* The velocity through the air points to the
# left of the course, into the wind. Its direction is called the *heading*.
#
# > **Predict first.** The wind has half of the UAV's air speed: 9 m/s against 18 m/s. It comes straight from the side.
# > Which share of the 18 m/s does it cost: none, an eighth, a quarter, or half?

# %% tags=["nbval-check-output"]
for side, blows in (("from behind", (9, 0)), ("from the side", (0, 9)), ("from ahead", (-9, 0))):
    speed = reachable_ground_speed(uav.top_speed, blows, course)
    print(f"9 m/s {side:<13}: {speed:4.1f} m/s over ground, {speed / uav.top_speed - 1:+.0%}")

# %% tags=["figure"]
angles = np.linspace(0, 180, 181)
blowing = np.stack([np.cos(np.radians(angles)), np.sin(np.radians(angles))], axis=1)
left = {f"wind {speed} m/s": reachable_ground_speed(uav.top_speed, speed * blowing, course) for speed in (3, 9, 15)}
figure = plot.lines(angles, left, "angle between wind and course", "reachable ground speed [m/s]",
                    limits={"asked for, 5 m/s": uav.cruise_speed}, y_range=(0, 35),
                    title="Reachable ground speed with 18 m/s through the air")  # fmt: skip
sides = ["0°\nfrom behind", "45°", "90°\nfrom the side", "135°", "180°\nfrom ahead"]
figure.axes[0].set_xticks(range(0, 181, 45), sides)
figure

# %% tags=["check"]
speeds_left = [float(reachable_ground_speed(18.0, blows, course)) for blows in ((9, 0), (0, 9), (-9, 0))]
assert np.allclose(speeds_left, (27.0, np.sqrt(18**2 - 9**2), 9.0))
assert round(1 - speeds_left[1] / 18, 2) == 0.13
assert left["wind 15 m/s"][-1] == 3
assert np.argmin(left["wind 15 m/s"]) == 180

# %% [markdown]
# *Reachable ground speed over the direction of the wind.* A side wind of half the air speed costs only 13 %. The same
# wind from ahead costs all of its 9 m/s. As long as the wind is slower than the UAV, **the worst wind is the head
# wind**. Where a line is below the grey one, the UAV is too slow. A side wind above $V_\text{uav}$ leaves no solution:
# the root in Eq. (7) becomes imaginary, and no heading holds the course.
#
# ## Hovering and flying are not the same
#
# Now all together. The UAV carries 0.6 kg, it is dry, and the mean wind is 10 m/s. A gust then has 17.5 m/s. First the
# UAV hovers. Then it flies against the wind with $V_d = 5$ m/s over ground, so the air of the gust passes it with
# $G W + V_d = 22.5$ m/s.
#
# > **Predict first.** The air is 1.29 times as fast in the second case. By how much does the drag grow? And is a thrust
# > of 28 N enough for both?

# %% tags=["figure"]
parcel = uav.loaded(0.6)
figure, panels = plot.new_panels(1, 2, width=9.6, height=5.1, share="y")
for axes, ground_speed in zip(panels, (0.0, 5.0), strict=True):
    force = wind_drag((17.5, 0), (-ground_speed, 0), parcel.drag_area)[0]
    does = f"flying west with {ground_speed:g} m/s" if ground_speed else "hovering"
    needed = np.hypot(force, parcel.weight)
    draw_forces(
        axes, parcel, force, f"0.6 kg, gust of 17.5 m/s from the west,\n{does}: thrust {needed:.1f} N", limit=True
    )
figure

# %% tags=["check"]
pushes = [wind_drag((17.5, 0), (-speed, 0), parcel.drag_area)[0] for speed in (0.0, 5.0)]
needs = [np.hypot(push, parcel.weight) for push in pushes]
assert [round(push, 1) for push in pushes] == [11.3, 18.6]
assert [round(need, 1) for need in needs] == [23.5, 27.8]
assert round(pushes[1] / pushes[0], 2) == 1.65

# %% [markdown]
# *A gust on a UAV with 0.6 kg of load, in dry weather.* The drag grows by 65 %. Hovering takes 23.5 of 28 N, flying
# against the gust 27.8 N.
#
# **How much force is left sideways?** By Pythagoras, the greatest thrust $T$ carries $m g + F_r$ and still pushes
# sideways with the *horizontal reserve*
#
# $$ F_h = \sqrt{T^2 - (m g + F_r)^2}. \tag{8} $$
#
# **Which air speed does it hold?** The drag of Eq. (4) must not exceed $F_h$. So the air may pass the UAV with at most
#
# $$ V_\text{held} = \sqrt{\frac{2 F_h}{\rho\, C_D A}}. \tag{9} $$

# %% tags=["nbval-check-output"]
for payload in (0.0, 0.25, 0.6, 1.0, 1.09):
    loaded = uav.loaded(payload)
    reserve = loaded.horizontal_reserve()
    print(f"{payload:.2f} kg: reserve {reserve:4.1f} N, V_held {wind_limit(loaded):.1f} m/s", end="; ")
    print(f"a steady 18 m/s would take {half * 18**2 / reserve:.0%} of the reserve")

# %% tags=["check"]
assert round(float(wind_limit(uav)), 1) == 25.5
assert round(half * 18**2 / float(uav.horizontal_reserve()), 2) == 0.50
assert round(np.degrees(np.arccos(uav.weight / 28))) == 58
assert round(np.degrees(uav.max_tilt)) == 60
assert wind_limit(uav.loaded(1.08)) > 18 > wind_limit(uav.loaded(1.085))

# %% [markdown]
# `wind_limit` is $V_\text{held}$, so a limit of the *air* speed. Why is $V_\text{uav}$ only 18 m/s, if the thrust holds
# 25.5 m/s? It isn't computed from the thrust. It stands for the limit that a maker sets for flight; ours is a little
# below the data sheets'. $V_\text{held}$ is what *all* of the reserve holds. Above 1.08 kg it is the smaller of the
# two.
#
# ## The flight envelope
#
# A UAV may fly with $V_d$ over ground in a mean wind $W$ from any side, if three conditions hold. We write them for the
# head wind. It leaves the least ground speed, and the air passes the UAV fastest in it.
#
# 1. It can lift: $M > 0$, Eq. (3).
# 2. It makes its way against the mean wind. Its steady air speed is $W + V_d$. Our limit $V_\text{uav}$ and the thrust
#    must both allow it: $W + V_d \le \min(V_\text{uav}, V_\text{held})$.
# 3. It holds the gusts. This can mean two things:
#    - *A gust may slow it down*, at worst until it stands still. Then it has to hold the gust as in hover, without
#      $V_d$: $G W \le V_\text{held}$.
#    - *It keeps its speed* in the gust. Then $G W + V_d \le V_\text{held}$.
#
# So condition 2 gives one limit of $W$, and condition 3 another, $V_\text{held}/G$ if it may be slowed down:
#
# $$ W \le \min(V_\text{uav}, V_\text{held}) - V_d
#    \qquad\text{and}\qquad
#    W \le \frac{V_\text{held}}{G} \quad\text{or}\quad W \le \frac{V_\text{held} - V_d}{G}. \tag{10} $$
#
# **What we assume.** The gust lasts until the forces balance; it blows level, and from ahead. It may take *all* of the
# thrust: nothing is left for steering, because $\delta$ stands in condition 1 only. The thrust is 28 N in thin air too.
# Load and tilt don't change the drag area. $G$ is for the wind above a city's roofs; in a street it may be other.
#
# By hand, in dry weather:


# %%
def wind_limits(payload, ground_speed, gust_factor=1.75, safety_factor=1.1):
    """Greatest mean wind [m/s]: where gusts may slow the UAV down, and where it keeps its speed."""
    weight = (1.5 + payload) * 9.81
    if 28 - safety_factor * weight <= 0:  # Eq. (3)
        return 0.0, 0.0
    reserve = np.sqrt(28**2 - weight**2)  # Eq. (8)
    held = np.sqrt(2 * reserve / (1.225 * 0.06))  # Eq. (9)
    steady = min(18.0, held) - ground_speed
    return min(held / gust_factor, steady), min((held - ground_speed) / gust_factor, steady)


# %% tags=["nbval-check-output"]
print("at 5 m/s over ground   slowed down   keeps its speed")
for payload in (0.0, 0.25, 0.6, 1.0, 1.1):
    slowed, kept = wind_limits(payload, 5.0)
    print(f"{payload:14.2f} kg {slowed:14.1f} m/s {kept:11.1f} m/s")

# %% tags=["check"]
from uavlab.weather import mean_wind_limit as library

table = [[round(limit, 1) for limit in wind_limits(payload, 5.0)] for payload in (0.0, 0.25, 0.6, 1.0, 1.1)]
assert table == [[13.0, 11.7], [13.0, 11.2], [13.0, 10.1], [11.0, 8.1], [0.0, 0.0]]
for payload in (0.0, 0.3, 0.7, 1.0, 1.1):
    for speed in (0.0, 5.0, 12.0):
        limits = [library(uav.loaded(payload), ground_speed=speed, keep_speed=keeps) for keeps in (False, True)]
        assert np.allclose(wind_limits(payload, speed), limits)
assert np.allclose(*wind_limits(0.5, 0.0))

# %% [markdown]
# The library's `mean_wind_limit` gives the same; its argument `keep_speed` chooses between the two. Over all loads:

# %% tags=["figure"]
from uavlab.weather import mean_wind_limit

payloads = np.linspace(0, 1.3, 651)
flying = payloads <= heaviest
loads = [uav.loaded(payload) for payload in payloads]
held = np.where(flying, [wind_limit(loaded) for loaded in loads], np.nan)
limits = [np.array([mean_wind_limit(one, ground_speed=5, keep_speed=kept) for one in loads]) for kept in (False, True)]
BOUNDS = {"limit of standing still in the gust": plot.ORANGE, "limit of 5 m/s in the gust": plot.BLUE,
          "limit of 5 m/s in the mean wind": plot.BLACK,
          "area: keeps its speed": plot.SKY, "area: gusts slow it down": plot.YELLOW}  # fmt: skip
bounds = {"limit of standing still in the gust": held / 1.75, "limit of 5 m/s in the gust": (held - 5) / 1.75,
          "limit of 5 m/s in the mean wind": np.minimum(held, 18) - 5}  # fmt: skip
areas = {"area: keeps its speed": (0, limits[1]), "area: gusts slow it down": (limits[1], limits[0])}
plot.lines(payloads, bounds, "load [kg]", "mean wind [m/s]", bands=areas, colors=BOUNDS, y_range=(0, 17),
           places={f"no lift margin above {heaviest:.3f} kg": heaviest}, notes={"grounded": (0.3, 15.2)},
           title="Flight envelope at 5 m/s over ground, G = 1.75, dry")  # fmt: skip

# %% tags=["check"]
cross = payloads[flying & (held / 1.75 < 13)][0]
assert 0.59 < cross < 0.60
assert (((held - 5) / 1.75)[flying] < (np.minimum(held, 18) - 5)[flying]).all()

# %% [markdown]
# *The flight envelope.* If gusts may slow the UAV down, its steady speed of 18 m/s is the limit, and from 0.6 kg on its
# thrust. If it is to keep its speed (blue line), thrust is the limit for every load. Above 1.095 kg the safety factor
# forbids the flight.
#
# And the rain? It presses like a small load. 300 mm/h is nearly the most ever measured:

# %% tags=["nbval-check-output"]
heavy, downpour = uav.loaded(1.0), rain_force(300, uav.rain_area)
dry, wet = wind_limit(heavy), wind_limit(heavy, downpour)
print(f"V_held with 1 kg: {dry:.2f} m/s when it is dry, {wet:.2f} m/s in 300 mm/h")
print(f"300 mm/h take {1000 * downpour / GRAVITY:.1f} g from the heaviest load")

# %% tags=["check"]
assert 0.05 < dry - wet < 0.1
assert round(1000 * float(downpour) / GRAVITY, 1) == 7.6
assert 0.15 < dry - wind_limit(heavy, 2 * downpour) < 0.2

# %% [markdown]
# **Wind and load ground this UAV. Even this rain moves the edges only a little**: the heaviest load by 8 g,
# $V_\text{held}$ with 1 kg by 0.1 m/s, and twice as much if all drops bounce. In the next figure `grounded_by` says
# which limit is broken, for a UAV that gusts may slow down.


# %%
from uavlab.weather import Weather, grounded_by


def envelope_at(wind, rain, load):
    """The envelope in this rain, and where this wind and this load lie in it."""
    weather, loaded = Weather(forecast_wind=wind, rain_mm_per_h=rain), uav.loaded(load)
    reasons = grounded_by(loaded, weather, ground_speed=5)
    force, air = rain_force(rain, uav.rain_area), weather.air_density
    fast = mean_wind_limit(loaded, force, ground_speed=5, air_density=air, keep_speed=True)
    verdict = "grounded" if reasons else "keeps its speed" if wind <= fast else "gusts slow it down"
    words = "\n".join(reasons) or f"May fly: {load:g} kg, wind {wind} m/s, rain {rain} mm/h"
    return draw_envelope(force, air, load, wind, verdict, words)


# %% tags=["figure"]
def draw_envelope(force, air, load, wind, verdict, title):
    """Both envelopes as areas, and a flight as a point."""
    how, edge = {"ground_speed": 5, "air_density": air}, heaviest - force / GRAVITY
    grid = np.sort([*np.linspace(0, 1.3, 131), edge - 1e-9, edge + 1e-9])
    slowed = np.array([mean_wind_limit(uav.loaded(one), force, **how) for one in grid])
    kept = np.array([mean_wind_limit(uav.loaded(one), force, keep_speed=True, **how) for one in grid])
    areas = {"area: keeps its speed": (0, kept), "area: gusts slow it down": (kept, slowed)}
    mark = f"this flight: {verdict}"
    looks = BOUNDS | {mark: plot.ORANGE if verdict == "grounded" else plot.GREEN}
    _, axes = plot.new_figure(6.4, 3.8)
    return plot.lines(grid, {}, "load [kg]", "mean wind [m/s]", bands=areas, points={mark: (load, wind)}, axes=axes,
                      y_range=(0, 18), colors=looks, title=f"At 5 m/s over ground, G = 1.75\n{title}")  # fmt: skip


labels = {"wind": "mean wind [m/s]", "rain": "rain [mm/h]", "load": "load [kg]"}
weathers = {"wind": [2, 5, 8, 11, 14, 17], "rain": [0, 300], "load": [0.0, 0.4, 0.8, 1.2]}
start = {"wind": 11, "load": 0.8}
plot.sliders(envelope_at, title="flight envelope", labels=labels, start=start, progress=False, **weathers)

# %% [markdown]
# *The envelope with one flight in it.* Raise the load or the wind until the flight is grounded, and read which limit it
# was. Then switch the rain on: the areas hardly move.
#
# ## How much hangs on our choices?
#
# We change our numbers, first one at a time, then three at once, for 0.6 kg at 5 m/s. Vehicle figures change by a tenth
# to a sixth. $G = 1.5$ lies between grass and suburb in the list above.

# %%
from dataclasses import replace


def with_other(thrust=28.0, drag_area=0.06, top_speed=18.0, gust_factor=1.75, safety_factor=1.1):
    """Both limits of the mean wind [m/s] for 0.6 kg at 5 m/s, and the heaviest load [kg]."""
    other = replace(parcel, thrust=thrust, drag_area=drag_area, top_speed=top_speed)
    how = {"ground_speed": 5.0, "gust_factor": gust_factor, "safety_factor": safety_factor}
    limits = [float(mean_wind_limit(other, keep_speed=keeps, **how)) for keeps in (False, True)]
    return *limits, thrust / (safety_factor * GRAVITY) - uav.mass


# %% tags=["nbval-check-output"]
single = {"thrust": (25, 28, 31), "drag_area": (0.05, 0.07), "top_speed": (15, 21)}
single |= {"gust_factor": (1.5, 2.03), "safety_factor": (1.0, 1.2)}
changes = [{name: value} for name, values in single.items() for value in values]
changes.append({"thrust": 25, "drag_area": 0.07, "gust_factor": 2.03})
changes.append({"thrust": 31, "drag_area": 0.05, "gust_factor": 1.5})
print(f"{'':<44} slowed down   keeps its speed   heaviest load")
for change in changes:
    slowed, kept, most = with_other(**change)
    words = ", ".join(f"{name} {value:g}" for name, value in change.items())
    print(f"{words:<44} {slowed:7.1f} m/s {kept:13.1f} m/s {most:12.3f} kg")

# %% tags=["check"]
keeps = [round(with_other(**change)[1], 1) for change in changes]
assert [min(keeps[:-2]), max(keeps[:-2]), *keeps[-2:]] == [8.4, 11.8, 6.5, 13.0]
slows = [round(with_other(**change)[0], 1) for change in changes[:-2]]
assert [min(slows), max(slows)] == [10.0, 13.0]
assert with_other(top_speed=21) == with_other()
assert with_other(top_speed=15)[:2] == (10, 10)
assert gust_factor(30.0, 0.05) < 1.5 < gust_factor(30.0, 0.3)

# %% [markdown]
# Single changes move the limit of 10.1 m/s, at which it keeps its speed, to between 8.4 and 11.8 m/s. Three bad or
# three good choices at once give 6.5 or 13.0 m/s. With a top speed of 15 m/s, condition 2 would be the limit:
# $15 - 5 = 10$ m/s. The safety factor decides on the heaviest load only.
#
# > **Try it.** Your UAV is smaller: 0.9 kg, 16 N of thrust, a drag area of 0.03 m², and again 18 m/s at most. In which
# > wind may it keep 5 m/s with 0.2 kg of load?

# %% tags=["try-it"]
small = replace(uav, mass=0.9, thrust=16.0, drag_area=0.03).loaded(0.2)
print(f"lift margin {lift_margin(small):.2f} N, V_held {wind_limit(small):.1f} m/s")
print(f"keeps 5 m/s in a mean wind of {mean_wind_limit(small, ground_speed=5, keep_speed=True):.1f} m/s")

# %% [markdown]
# ## How often is it grounded in real weather?
#
# We take the 8 760 hours of a *typical year* at the airport of Greensboro, North Carolina: for each month, the one of
# thirty years whose sun, temperature and wind were the closest to the long-term ones. Each hour has its wind and its
# air density. We treat the wind as a ten-minute mean; the record doesn't say over which time it averages.
#
# The airport measures about 10 m above grass. Near the ground the mean wind grows with the logarithm $\ln(z/z_0)$. With
# $z_0 = 0.05$ m for grass, the wind at 60 m is $\ln(60/0.05)/\ln(10/0.05) = 1.34$ times that at 10 m. Here $G$ is Eq.
# (6) over grass, at both heights. We count the hours in which the UAV can't keep its speed against a head wind:

# %%
year = greensboro_weather()
density = air_density(year.temperature_c, year.humidity_percent, year.pressure_hpa)


def hours_grounded(payload, ground_speed, height):
    """Hours of the year in which the UAV can't keep this speed over ground with this load."""
    gusts = gust_factor(height, 0.05)
    how = {"ground_speed": ground_speed, "gust_factor": gusts, "air_density": density, "keep_speed": True}
    wind = year.wind_speed * np.log(height / 0.05) / np.log(10 / 0.05)
    return int((wind > mean_wind_limit(uav.loaded(payload), **how)).sum())


# %% tags=["nbval-check-output"]
print("hours grounded, of 8 760, at a ground speed of")
print("            at 10 m height            at 60 m height")
print("          0 m/s   5 m/s  10 m/s    0 m/s   5 m/s  10 m/s")
for payload in (0.0, 0.6, 1.0):
    low, high = ([hours_grounded(payload, speed, height) for speed in (0, 5, 10)] for height in (10.0, 60.0))
    print(f"{payload:.2f} kg", *(f"{count:7,}" for count in low), " ", *(f"{count:7,}" for count in high))

# %% tags=["figure"]
speeds = np.arange(0, 15.5, 0.5)
figure, panels = plot.new_panels(1, 2, width=9.0, height=4.0, share="y")
for axes, height in zip(panels, (10.0, 60.0), strict=True):
    shares = {
        f"load {payload:g} kg": np.array([100 * hours_grounded(payload, v, height) / len(year) for v in speeds])
        for payload in (1.0, 0.6)
    }
    plot.lines(speeds, shares, "speed to keep over ground [m/s]", "hours grounded [%]", log="y", y_range=(0.005, 200),
               title=f"Can't keep its speed, Greensboro, {height:.0f} m high", axes=axes)  # fmt: skip
figure

# %% tags=["check"]
flights = [(speed, height) for height in (10.0, 60.0) for speed in (0, 5, 10)]
assert [hours_grounded(0.0, *flight) for flight in flights] == [0, 1, 104, 1, 21, 650]
assert [hours_grounded(0.6, *flight) for flight in flights] == [1, 1, 104, 1, 24, 650]
assert [hours_grounded(1.0, *flight) for flight in flights] == [1, 26, 526, 10, 165, 1238]
assert round(100 * 104 / 8760, 1) == 1.2
assert year.wind_speed.nunique() < 60
assert all((wind_limit(uav.loaded(0.6)) - 10) / gust_factor(height, 0.05) > 18 - 10 for height in (10.0, 60.0))
assert all((wind_limit(uav.loaded(1.0)) - 10) / gust_factor(height, 0.05) < 18 - 10 for height in (10.0, 60.0))
assert round(np.log(60 / 0.05) / np.log(10 / 0.05), 2) == 1.34

# %% [markdown]
# *Share of the hours in which the UAV is grounded, on a logarithmic scale; 0.01 % is about one hour a year.* (The
# record is rounded to few wind speeds, so the lines have steps.) With 0.6 kg at 5 m/s and 10 m height, one hour is too
# windy. Changing one of these, we find 26 hours with 1 kg, 24 at 60 m and 104 (1.2 %) at 10 m/s. At 10 m/s the counts
# for 0 and 0.6 kg are the same: the limit is $18 - 10 = 8$ m/s of condition 2, whatever the load.
#
# A typical year has no rare storms.
#
# ## How long does a gust last? Reading a spectrum
#
# So far a gust was one steady number, the strongest wind. From here on we call all of the swings gusts. Let $u(t)$ be
# the wind along its mean direction minus its mean, with the standard deviation $\sigma_u$.
#
# **Sines.** $u(t) = b \sin(\Omega t)$ with the *angular frequency* $\Omega$ [rad/s] takes $2\pi/\Omega$ seconds for a
# swing. The mean of $\sin^2$ is ½, so its variance is $b^2/2$. For two sines with different frequencies the mean of
# their product is zero, so their variances add up. NumPy's `rfft` splits a record of $n$ samples into sines that swing
# 0, 1, 2, … times in it. It gives a complex number for each; $2/n$ times its absolute value is the amplitude:

# %% tags=["nbval-check-output"]
count, step = 4096, 0.1
time = step * np.arange(count)
slow, fast = 2 * np.pi * np.array([20, 200]) / (count * step)  # 20 and 200 swings
signal = 1.0 * np.sin(slow * time) + 0.5 * np.sin(fast * time + 1.0)
variance = (2 * np.abs(np.fft.rfft(signal)) / count) ** 2 / 2
for k in (20, 200):
    print(f"{2 * np.pi * k / (count * step):.2f} rad/s: variance {variance[k]:.3f}")
print(f"all frequencies {variance.sum():.3f}, the signal itself {signal.var():.3f}")

# %% tags=["check"]
assert np.isclose(variance.sum(), signal.var())
assert np.isclose(signal.var(), 0.5 + 0.125)

# %% [markdown]
# **Gusts** are a sum of very many sines. So we count variance per frequency. In the **spectrum** $S_u(\Omega)$, the
# sines between $\Omega$ and $\Omega + d\Omega$ together have the variance $S_u(\Omega)\, d\Omega$. Its unit is (m/s)²
# per rad/s, and over all positive frequencies it adds up to
#
# $$ \int_0^\infty S_u(\Omega)\, d\Omega = \sigma_u^2. \tag{11} $$
#
# **Dryden's form** for the gusts along the wind stands in the US military specification MIL-F-8785C, section 3.7:
#
# $$ S_u(\Omega) = \frac{2 \sigma_u^2 \tau_u}{\pi}\, \frac{1}{1 + (\tau_u \Omega)^2}. \tag{12} $$
#
# Of its two parameters, $\sigma_u$ says how strong the gusts are. $\tau_u$ says for how many seconds the wind remembers
# a gust: the correlation between $u(t)$ and $u(t + s)$ is $e^{-s/\tau_u}$. (That Eq. (12) is its Fourier transform, we
# take as given.) Since $\int dx/(1 + x^2) = \arctan x$, the share $\frac2\pi \arctan(\tau_u \Omega)$ of the variance
# lies below $\Omega$, so half of it lies below $1/\tau_u$. Behind it stand eddies about $L_u$ long that the air carries
# past the UAV, so $\tau_u = L_u/V_\text{rel}$. With the height $z$ in metres, $W_6$ the wind at 6.1 m (20 feet) and
# $q = 0.177 + 0.0027 z$, the specification sets $L_u = z/q^{1.2}$ and $\sigma_u = 0.1\, W_6/q^{0.4}$. For 8 m/s at 30 m
# over grass, the logarithm above gives $W_6 = 6.0$ m/s.

# %% tags=["nbval-check-output"]
from uavlab.weather import dryden_gusts, dryden_parameters, dryden_spectrum

hover = {"air_speed": 8.0, "altitude": 30.0, "wind_at_6m": 6.0}
lengths, deviations = dryden_parameters(hover["altitude"], hover["wind_at_6m"])
sigma, memory = deviations[0], lengths[0] / hover["air_speed"]
print(f"along the wind: σ_u = {sigma:.2f} m/s, L_u = {lengths[0]:.0f} m, τ_u = {memory:.0f} s")
print(f"of a gust are left on average {np.exp(-3 / memory):.0%} after 3 s, {np.exp(-1):.0%} after τ_u")
print(f"flying against it with 5 m/s: τ_u = {lengths[0] / 13:.0f} s")
print(f"swings faster than 6.3 s (1 rad/s) have {1 - 2 / np.pi * np.arctan(memory):.1%} of the variance")
print(f"Eurocode: σ_u = {8 / np.log(30 / 0.05):.2f} m/s")

# %% tags=["check"]
assert round(8 * np.log(6.1 / 0.05) / np.log(30 / 0.05), 1) == 6.0
assert (round(sigma, 2), round(memory), round(lengths[0] / 13), round(np.exp(-3 / memory), 2)) == (1.03, 19, 12, 0.85)
shape = 0.177 + 0.0027 * 30
assert np.allclose((lengths[0], sigma), (30 / shape**1.2, 0.6 / shape**0.4), rtol=1e-3)
assert round(8 / np.log(30 / 0.05), 2) == 1.25
assert round(1 - 2 / np.pi * np.arctan(memory), 3) == 0.033
assert np.isclose(dryden_spectrum(0.3, **hover)[0], 2 * sigma**2 * memory / np.pi / (1 + (memory * 0.3) ** 2))

# %% [markdown]
# **So a gust lasts some 19 s** over grass in hover, and 12 s in flight against it, until a good third is left. Dryden's
# model knows no buildings.
#
# The same wind has two $\sigma_u$, 1.25 and 1.03 m/s, because they come from *two models*. The Eurocode's is made for
# buildings and gives the strongest gust. Dryden's is made for aircraft and gives the swings in time. Neither is a
# measurement. Our envelope uses the Eurocode's alone.
#
# Now we make gusts that forget exponentially. In each step, the share $e^{-\Delta t/\tau_u}$ of the old gust is kept. A
# random part is added, just large enough to keep the variance at $\sigma_u^2$:


# %%
def gusts_along(count, step, sigma, memory, rng):
    """Gusts along the wind [m/s], `count` samples `step` seconds apart."""
    kept = np.exp(-step / memory)
    fresh = sigma * np.sqrt(1 - kept**2) * rng.standard_normal(count)
    gust = np.empty(count)
    gust[0] = sigma * rng.standard_normal()
    for i in range(1, count):
        gust[i] = kept * gust[i - 1] + fresh[i]
    return gust


# %% [markdown]
# Have they the spectrum of Eq. (12)? We make 28 hours of them. At each frequency, the spectrum of one record scatters
# by as much as its mean. So SciPy's `welch` cuts the record into pieces of 14 minutes and averages their spectra.

# %%
from scipy.signal import welch

step = 0.1
gusts = gusts_along(1_000_000, step, sigma, memory, np.random.default_rng(3))
hertz, estimate = welch(gusts, 1 / step, nperseg=8192)
frequency, found = 2 * np.pi * hertz[1:], estimate[1:] / (2 * np.pi)  # welch: per Hz, 1 Hz = 2π rad/s
model = 2 * sigma**2 * memory / np.pi / (1 + (memory * frequency) ** 2)

# %% tags=["nbval-check-output"]
print("band [rad/s]     estimate over Eq. (12), scatter of single frequencies")
for low, high in ((0.01, 0.05), (0.05, 0.5), (0.5, 5.0), (5.0, 31.0)):
    ratio = (found / model)[(frequency > low) & (frequency < high)]
    print(f"{low:5.2f} to {high:5.2f}   {ratio.mean():10.2f} {ratio.std():10.2f}")

# %% tags=["figure"]
figure, (left_panel, right_panel) = plot.new_panels(1, 2, width=9.6, height=4.0)
shown = 8 + gusts[:1200]
plot.lines(step * np.arange(1200), {"wind with gusts": shown}, "time [s]", "wind speed [m/s]", axes=left_panel,
           limits={"long-term mean": 8.0}, title="Two minutes, 30 m above grass")  # fmt: skip
plot.lines(frequency, {"spectrum of the gusts, estimated": found, "Dryden, Eq. (12)": model},
           "angular frequency Ω [rad/s]", "spectrum [(m/s)² per rad/s]", log="xy", places={"1/τᵤ": 1 / memory},
           title="Spectrum, 8 m/s, 30 m above grass", axes=right_panel)  # fmt: skip
figure

# %% tags=["check"]
bands = [(frequency > low) & (frequency < high) for low, high in ((0.01, 0.05), (0.05, 0.5), (0.5, 5.0), (5.0, 31.0))]
ratios = [(found / model)[band].mean() for band in bands]
assert np.allclose(ratios[:3], 1, atol=0.03)
assert ratios[3] > 1.3
assert np.isclose(gusts.std() / sigma, 1, atol=0.05)
assert (round(shown.mean(), 1), round(shown.max(), 1)) == (8.6, 10.3)
theirs = dryden_gusts(36_000, step, **hover, rng=2)[:, 0]
_, other = welch(theirs, 1 / step, nperseg=8192)
assert np.isclose((other[1:] / (2 * np.pi) / model)[bands[1] | bands[2]].mean(), 1, atol=0.03)
assert np.isclose(theirs.std() / sigma, 1, atol=0.06)

# %% [markdown]
# *Gusts made by hand, and their spectrum on logarithmic scales.* These two minutes happen to have a mean of 8.6 m/s:
# swings are slow, so short means scatter. From 0.01 to 5 rad/s the means of the bands agree with Eq. (12) within 2 %.
# Above 5 rad/s the estimate is too high: with ten samples a second, faster swings look like slower ones (*aliasing*).
#
# Until it has tilted, a gust pushes the UAV aside. How far? That is the question of the next chapters.
#
# ## Remember
#
# - Drag grows with the square of the *air* speed, wind minus velocity. Twice the air speed makes four times the force.
# - The force of rain is a few grams' worth. Wind and load decide, except at the very edge.
# - A load takes thrust in two ways: it needs more upwards, and leaves less sideways.
# - In flight against a gust, the air passes the UAV with $G W + V_d$. So an envelope has to say whether the UAV hovers,
#   may be slowed down, or keeps its speed.
# - Every envelope hangs on chosen numbers. Change them one by one.
# - A spectrum says how much of a signal's variance lies at which frequency. In Dryden's, half lies below $1/\tau_u$,
#   and $\tau_u = L_u/V_\text{rel}$ is how long a gust lasts.
#
# ## What the paper says, what we find
#
# | REPARE | says, in the text that we have | we find |
# |---|---|---|
# | Eq. 1 | $F_r = H_r \rho_r V_r (1 - \eta_r)/t$, with the "amount of precipitation" $H_r$, density $\rho_r$, speed $V_r$ and "momentum loss" $\eta_r$ of the rain | a force if $H_r$ is a volume; for a depth the area is missing, and it is a pressure. If $\eta_r$ is the share of the momentum that the UAV doesn't take, it is right for drops that don't bounce; bouncing drops need a factor above 1. Eq. (2): 0.025 N in 100 mm/h |
# | Eq. 2 | $F_{z\text{Max}} > \delta_r (G_\text{uav} + G_s) + F_r$: thrust, safety factor, weights of UAV and load | the same as Eq. (3), but rain stands outside of the bracket; the difference $(\delta - 1) F_r$ is 0.0025 N in 100 mm/h |
# | Eq. 3 | the larger of two mean winds | a gust is needed beside it; with $G = 1.75$ it pushes 3.06 times as hard |
# | Eq. 4 | $\vec V_d \le \vec v = \vec V_\text{wMax} + \vec V_\text{uav}$: speed asked for, over ground, of the wind, of the UAV | the sum is the wind triangle; $\le$ has to compare sizes, and the direction of $\vec V_\text{uav}$ is left open. Eq. (7) fills that in |
# | Eq. 5 | drag is $\frac12 C \rho_a S_w \vec V_d$, with drag coefficient, air density, area | in kg/s, not a force (a square may be lost in our text), along the motion instead of against it, and from the ground speed: no drag for a UAV that hovers in a storm |
# | Table 3 (loads and winds), note 2 | heavy rain may press harder than the largest load weighs | not by its force on our UAV: even 0.25 kg would take at least 4.9 m of rain an hour; water that stays may weigh 100 g |
# | Table 4 (safe distances) | a heavy load flies in mild wind | can't be checked without the paper's vehicle; ours lifts 1 kg if $\delta < 1.14$, and we chose 1.1 for that |
#
# ## Read on
#
# - EN 1991-1-4:2005, *Eurocode 1: Actions on structures, Wind actions*, section 4,
#   [eurocodes.jrc.ec.europa.eu](https://eurocodes.jrc.ec.europa.eu/): mean wind, roughness, turbulence and gusts.
# - MIL-F-8785C, *Flying Qualities of Piloted Airplanes*, US Department of Defense, 1980, section 3.7,
#   [everyspec.com](http://everyspec.com/MIL-SPECS/MIL-SPECS-MIL-F/MIL-F-8785C_5295/): Dryden's spectra, and their
#   parameters.
# - R. W. Beard and T. W. McLain, *Small Unmanned Aircraft: Theory and Practice*, Princeton University Press, 2012,
#   chapters 2 and 4: the wind triangle, forces, Dryden's gusts.
# - R. Gunn and G. D. Kinzer, "The terminal velocity of fall for water droplets in stagnant air", *Journal of
#   Meteorology* 6 (1949) 243–248,
#   [doi:10.1175/1520-0469(1949)006<0243:TTVOFF>2.0.CO;2](https://doi.org/10.1175/1520-0469%281949%29006%3C0243:TTVOFF%3E2.0.CO;2):
#   how fast drops fall.
#
# ## Your turn
#
# Six exercises, from a gust in flight to a delivery that carries as much as it can:
# [exercises/01_wind_and_rain_exercises.ipynb](exercises/01_wind_and_rain_exercises.ipynb).
#
# Before: [00 Start here](00_start_here.ipynb). Next: [02 The Pauta criterion](02_pauta.ipynb).
