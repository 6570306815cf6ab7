# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 03 Predicting the disturbance: how far will gusts push tomorrow?
#
# Tomorrow a small UAV flies between high buildings. A forecast says how warm it will be and how the wind will blow. The
# pilot needs another number: how far gusts will push the UAV away from where it should be, because that much room has
# to stay around it. From the weather of many earlier flights, and how far each was pushed, a program can learn it. We
# ask how good it can be at best, and decide how much room to keep.
#
# | | |
# |---|---|
# | **You will be able to** | fit a model to data and test it without flattering it; build two rounds of XGBoost by hand; compute the best accuracy that any model can reach; see whether predicted probabilities can be believed; turn a prediction into a distance that is exceeded as rarely as you ask for |
# | **You need** | chapters [01](01_wind_and_rain.ipynb) (drag, thrust) and [02](02_pauta.ipynb) (normal distribution); derivatives, NumPy; nothing of machine learning |
# | **Time** | 75 minutes to read, 40 seconds to run |
# | **Paper** | REPARE, section 2.2.3 and Fig. 4 ([doi:10.3390/s22062151](https://doi.org/10.3390/s22062151)) |

# %%
import warnings
from pathlib import Path

import numpy as np
import pvlib
from scipy.stats import norm, t
from sklearn.ensemble import RandomForestClassifier
from sklearn.inspection import permutation_importance
from sklearn.linear_model import Ridge
from sklearn.metrics import confusion_matrix
from sklearn.model_selection import GroupKFold, KFold, PredefinedSplit, cross_val_predict, train_test_split
from sklearn.naive_bayes import GaussianNB
from xgboost import XGBClassifier, XGBRegressor

from uavlab import plot, prediction
from uavlab.offsets import minimum_safe_distance
from uavlab.prediction import FEATURES, OffsetPredictor
from uavlab.statistics import share_interval
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import air_density, greensboro_weather

# %% [markdown]
# ## What REPARE does
#
# The *offset* $\xi$ of a flight is the largest distance, in metres, between the UAV and the place where it should be.
# REPARE predicts it from six *features* of the weather: temperature, humidity, pressure, wind speed, wind direction
# and solar radiation. It predicts a *class*, which we read as the offset, rounded up to whole metres: a flight of
# class 3 was pushed by more than 2 m and at most 3 m. A program that names a class is a *classifier*. The paper let
# three kinds of models learn from 5864 samples, and tested them on 1466 others.
#
# ## The data: measured weather, simulated offsets
#
# **Nobody measured the offsets of this chapter.** REPARE's flights aren't published. So a *simulator* of our own
# gives each hour of measured weather one flight with an offset. The *methods* are the same for real flights; the
# *metres* hold for our simulator only.
#
# The weather is a *typical year* at the airport of Greensboro, North Carolina. The archive TMY3
# ([manual](https://www.nrel.gov/docs/fy08osti/43156.pdf)) puts it together from twelve months of 1980 to 2003. **Each
# flight gets the weather that was measured in its hour, not a forecast.** So our results hold for a perfect forecast;
# the errors of a real one come on top.

# %% tags=["nbval-check-output"]
hours = greensboro_weather()
features = hours[list(FEATURES)]
day = np.arange(len(hours)) // 24  # the day that each hour belongs to, 0 to 364
print(f"{len(hours)} hours of {day.max() + 1} days;", *FEATURES)
print(f"mean wind {hours.wind_speed.mean():.1f} m/s, highest {hours.wind_speed.max():.1f} m/s")
print(f"calm in {(hours.wind_speed == 0).mean():.0%} of the hours")

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 3, width=10.0, height=3.2)
counts, edges = np.histogram(hours.wind_speed, np.arange(-1.5, 17.0, 1.0))
plot.lines(edges[:-1] + 0.5, {"number of hours": counts}, "wind speed [m/s]", "hours in the year", steps=True,
           title="how strong the wind is", colors={"number of hours": plot.BLUE}, axes=panels[0])  # fmt: skip
panels[0].set(xlim=(-1, 17), xticks=range(0, 17, 4))
panels[0].text(0, counts[1] / 2, "calm", ha="center", rotation=90)
hour_of_day = (np.arange(len(hours)) % 24) + 1
for axes, column, label, name, color in (
    (panels[1], "wind_speed", "mean wind speed [m/s]", "wind", plot.GREEN),
    (panels[2], "radiation", "mean radiation [W/m²]", "solar radiation", plot.ORANGE),
):
    mean = hours[column].groupby(hour_of_day).mean()
    plot.lines(mean.index, {name: mean}, "hour of the day", label, title=f"{name} over the day", axes=axes,
               y_range=(0, None), colors={name: color})  # fmt: skip
figure

# %% [markdown]
# *The weather of Greensboro.* Nearly all winds below 1.5 m/s are recorded as calm. The wind rises with the sun, so
# the features are not independent of each other.
#
# ### From the weather to an offset
#
# The simulator follows chapter 01. The UAV flies 45 m above the ground, in a street that runs at 60° (clockwise from
# north). The wind at the station has the speed $W$ and comes from the direction $\theta$; $R$ is the solar radiation,
# and $I_u$ the *turbulence intensity*: the standard deviation of the wind speed over its mean. The strongest gust of
# the flight has the speed
#
# $$ V = 1.4\,W\,\bigl[1 + 0.38\cos 2(\theta - 60°)\bigr]\,(1 + 2.5\,I_u), \qquad
#    I_u = 0.2 + \frac{0.3\,R/(1000\text{ W/m}^2)}{1 + W/(3\text{ m/s})}. \tag{1} $$
#
# The bracket is 1.38 for wind along the street, and 0.62 across. The gust pushes with the force
# $F_w = \tfrac12\rho\,C_D A\,V^2$. The vertical part of the greatest thrust $T$ carries the weight $m g$; by Pythagoras
# $\sqrt{T^2 - (m g)^2}$ is left against the wind. The *typical offset* grows with the share of this reserve that the
# gust takes:
#
# $$ \tilde\xi = 0.5\text{ m} + 8.5\text{ m}\cdot\frac{F_w}{\sqrt{T^2 - (m g)^2}}. \tag{2} $$
#
# At $\tilde\xi$ = 9 m the gust takes the whole reserve. A stronger one blows the UAV away; we still
# count the metres of Eq. 2 there, in 13 hours of the year.


# %%
def typical_offset(weather, uav, street_deg=60.0):
    """Median offset of a flight in each hour of a weather [m] (Eqs 1 and 2)."""
    wind, sun = weather["wind_speed"], weather["radiation"] / 1000
    along = np.cos(2 * np.radians(weather["wind_from_deg"] - street_deg))  # 1 along the street, -1 across
    turbulence = 0.2 + 0.3 * sun / (1 + wind / 3.0)
    gust = 1.4 * wind * (1 + 0.38 * along) * (1 + 2.5 * turbulence)
    density = air_density(weather["temperature_c"], weather["humidity_percent"], weather["pressure_hpa"])
    force = 0.5 * density * uav.drag_area * gust**2
    reserve = np.sqrt(uav.thrust**2 - uav.weight**2)
    return 0.5 + 8.5 * force / reserve


uav = LIGHT_QUADROTOR  # thrust 28 N, 1.5 kg, drag area 0.06 m², diameter 1 m, without payload
typical = typical_offset(features, uav).to_numpy()

# %% tags=["check"]
assert (uav.thrust, uav.mass, uav.drag_area, uav.diameter) == (28.0, 1.5, 0.06, 1.0)
assert np.allclose(typical, prediction.median_offsets(features, uav), rtol=1e-12)
assert prediction.median_offsets(features, uav, street_axis_deg=150.0)[1] == typical_offset(features, uav, 150.0)[1]
record, _ = pvlib.iotools.read_tmy3(Path(pvlib.__file__).parent / "data" / "723170TYA.CSV", map_variables=True)
years = {(date.month, date.year) for date in record.index - np.timedelta64(30, "m")}
assert len(years) == 12
assert (min(year for _, year in years), max(year for _, year in years)) == (1980, 2003)
assert ((hours.wind_speed > 0) & (hours.wind_speed < 1.5)).sum() < 20 < 1000 < (hours.wind_speed == 0).sum()
assert abs(1 / np.log(45 / 0.3) - 0.2) < 1e-3
assert abs((45 / 10) ** 0.22 - 1.4) < 0.01
peaks = np.random.default_rng(0).standard_normal((4000, 100)).max(axis=1)
assert abs(peaks.mean() - 2.5) < 0.03

# %% tags=["check"]
cases = [(uav.loaded(0.25), 6), (uav.loaded(1.0), 6), (uav.loaded(0.25), 9)]
shares = [0.5 * 1.225 * 0.06 * (1.75 * w) ** 2 / np.sqrt(u.thrust**2 - u.weight**2) for u, w in cases]
fitting = [k for k in np.arange(5, 12, 0.01) if list(np.ceil(1 + k * np.array(shares))) == [3, 4, 5]]
assert abs(min(fitting) - 7.3) < 0.05
assert abs(max(fitting) - 9.7) < 0.05
assert abs(np.mean([min(fitting), max(fitting)]) - 8.5) < 0.05

# %% [markdown]
# | number | what it is | where it comes from |
# |---|---|---|
# | UAV, 60°, 45 m | what flies, and where | our choice |
# | 1.4 | wind at 45 m over wind at the station's 10 m | our choice: $(45/10)^{0.22}$, a power law with an exponent for suburbs |
# | 0.2 | $I_u$ without sun | $1/\ln(z/z_0)$ at $z$ = 45 m, by the European standard for wind loads (EN 1991-1-4); $z_0$ = 0.3 m tells how rough suburbs are |
# | 0.3, 3 m/s | what full sun adds to $I_u$ in calm air; the wind that halves it | our choice: the sun stirs the air, most of all in light wind |
# | 2.5 | the strongest gust, in standard deviations above the mean | our choice: the largest of 100 normal values, on average, as if a flight had about 100 gusts |
# | 0.5 m | the offset in calm air | our choice: no autopilot holds its place exactly |
# | 8.5 m | scale: what is added if a gust takes the whole reserve | with the simpler gusts of chapter [07](07_repare.ipynb), all scales from 7.3 to 9.7 m give the three distances of REPARE's Table 4; we take the middle, and don't fit it anew for Eq. 1 |
# | 0.38, and $s$ below | the street, and the noise | *tuned* so that two of REPARE's three models come out about as accurate as in the paper; other pairs may do so, too |
#
# ### The same weather, another push
#
# The simulator multiplies the typical offset by a random factor whose logarithm is normal, with standard deviation
# $s$:
#
# $$ \ln \xi = \ln\tilde\xi + s\,\varepsilon, \quad \varepsilon \sim N(0, 1), \quad s = 0.21; \qquad
#    j = \min(\lceil \xi / 1\text{ m}\rceil, 6). \tag{3} $$
#
# So $\tilde\xi$ is the median of the offsets in that weather, and two thirds of the factors lie between
# $\exp(-0.21) = 0.81$ and $\exp(0.21) = 1.23$. The class is $j$. Class 6 is *open*: it holds all offsets above 5 m,
# however large. (Six classes of 1 m are our choice; the paper's text names neither number nor width.)

# %%
noise = np.exp(0.21 * np.random.default_rng(3).standard_normal(len(hours)))
offsets = typical * noise
classes = np.clip(np.ceil(offsets), 1, 6).astype(int)
for j in range(1, 7):
    print(f"class {j}: {(classes == j).mean():5.1%} of the flights")
print(f"typical offset above 9 m in {(typical > 9).sum()} hours; largest offset {offsets.max():.1f} m")

# %% tags=["check"]
assert (classes == prediction.offset_class(offsets)).all()
assert (typical > 9).sum() == 13
assert abs((classes == 1).mean() - 0.46) < 0.005
assert abs(norm.cdf(1) - norm.cdf(-1) - 2 / 3) < 0.02

# %% tags=["figure"]
angles, still = np.arange(0.0, 361.0, 2.0), features.mean()
medians = {f"wind {w} m/s": typical_offset({**still, "wind_from_deg": angles, "wind_speed": w}, uav) for w in (3, 6)}
bands = {name: (m * np.exp(-0.21), m * np.exp(0.21)) for name, m in medians.items()}
near = (hours.wind_speed - 6).abs() < 0.5
flights = {"flights, wind 5.5 to 6.5 m/s": np.column_stack([hours.wind_from_deg[near], offsets[near]])}
figure = plot.lines(angles, medians, "wind from [degrees clockwise from north]", "offset [m]", bands=bands,
                    band_label="two thirds of the factors", points=flights, y_range=(0, 9.5),
                    title="how far the same wind pushes from different directions",
                    colors={"wind 3 m/s": plot.BLUE, "wind 6 m/s": plot.ORANGE, "flights, wind 5.5 to 6.5 m/s": "0.3"},
                    places={"along the street": 60.0, "along the street ": 240.0})  # fmt: skip
figure.axes[0].set(xticks=range(0, 361, 60), yticks=range(10))
figure

# %% tags=["check"]
assert abs(medians["wind 6 m/s"].max() - 4.6) < 0.05
assert abs(medians["wind 6 m/s"].min() - 1.3) < 0.05
assert abs(offsets[near].max() - 9.1) < 0.05
assert abs(typical[near][offsets[near].argmax()] - 4.4) < 0.05

# %% [markdown]
# *The simulated offset over the direction of the wind, in average weather for the lines. The station reports the
# direction in steps of 10°.* A wind of 6 m/s typically pushes by 4.6 m when it blows along the street, and by 1.3 m
# when it blows across. (The flight at 9.1 m drew a random factor of 2.1.)
#
# **An offset has no direction here.** The simulator doesn't say how much of $\xi$ goes where. Like REPARE we keep one
# distance on all sides, as if all of $\xi$ could go towards the nearest obstacle.
#
# ## A fit in ten lines
#
# `XGBClassifier` is the model that REPARE chose. It learns from four fifths of the flights (`fit`), and names the
# classes of the rest (`predict`). The *accuracy* is the share of right classes. XGBoost counts classes from 0.
#
# > **Predict first.** A model that always says "class 1" is right in 46 % of the cases. How accurate will XGBoost be:
# > 60, 75, 90 or 99 %?

# %%
learn_x, test_x, learn_j, test_j = train_test_split(features, classes, test_size=0.2, random_state=0)
model = XGBClassifier(n_jobs=1, random_state=0)
model.fit(learn_x, learn_j - 1)
predicted = 1 + model.predict(test_x)
right = int((predicted == test_j).sum())
low, high = share_interval(right, len(test_j))
print(f"{len(learn_j)} flights to learn from, {len(test_j)} to test on")
print(f"accuracy {right / len(test_j):.1%}, 95 % interval from {low:.1%} to {high:.1%}")

# %% tags=["check"]
assert (len(learn_j), len(test_j)) == (7008, 1752)
assert abs(right / len(test_j) - 0.74) < 0.012
assert abs(high - low - 0.042) < 0.003

# %% [markdown]
# About 74 %. A *95 % interval* holds the true accuracy in at least 95 of 100 such tests; `share_interval` computes it
# from both counts, by the binomial distribution.
#
# > **Try it.** Split in another way: `random_state=1` in `train_test_split`. Does the accuracy change by more than luck
# > explains?

# %% tags=["try-it"]
a_x, b_x, a_j, b_j = train_test_split(features, classes, test_size=0.2, random_state=1)
again = XGBClassifier(n_jobs=1, random_state=0).fit(a_x, a_j - 1)
print(f"accuracy {(1 + again.predict(b_x) == b_j).mean():.1%}")

# %% [markdown]
# That is inside the interval. Which flights are the wrong ones? A *confusion matrix* has a row for each true class and
# a column for each predicted one.

# %% tags=["figure"]
confused = confusion_matrix(test_j, predicted, labels=range(1, 7), normalize="true")
names = [str(j) for j in range(1, 7)]
plot.matrix(100 * confused, names, names, "true class", "predicted class", "share of the row [%]",
            title="what the flights of each class were taken for [%]")  # fmt: skip

# %%
too_low, too_high = predicted < test_j, predicted > test_j
print(f"too low: {too_low.mean():.0%} of the flights, too high: {too_high.mean():.0%}")

# %% tags=["check"]
assert abs((predicted < test_j).mean() - 0.15) < 0.012
assert (np.diag(confused)[2:] < np.diag(confused)[:2].min()).all()

# %% [markdown]
# *Each row adds up to 100 %.* Left of the diagonal the prediction is too low. These 15 % are the dangerous flights;
# accuracy doesn't tell them from those that are too high.
#
# ## What XGBoost does, by hand
#
# The idea of XGBoost (*extreme gradient boosting*) is simple: predict badly, look at the errors, add a small
# correction, and repeat. Each correction is a *decision tree*: a few questions such as "is the wind below 3.3 m/s?",
# and a number for each branch. The smallest tree, a *stump*, asks one question.
#
# We build two rounds of it for one feature, the wind speed $x$, and for a number instead of a class: $y = \ln \xi$. Let
# $\hat y_i$ be the prediction for flight $i$ so far, and $e_i = y_i - \hat y_i$ its error. We look for one value $v$ that
# corrects the $n$ flights of a branch. XGBoost chooses the $v$ that makes
#
# $$ L(v) = \tfrac12\sum_{i=1}^{n} (e_i - v)^2 + \tfrac12\lambda v^2 \tag{4} $$
#
# smallest. The first term is the squared error that remains. The second holds $v$ small where there are few flights;
# the library's default is $\lambda = 1$. The derivative is $-\sum e_i + n v + \lambda v$. It is zero for
#
# $$ v = \frac{\sum e_i}{n + \lambda}. \tag{5} $$
#
# Without $\lambda$ this is the mean error. How much does the branch gain? We multiply out Eq. 4, which gives
# $L(v) = \tfrac12\sum e_i^2 - v\sum e_i + \tfrac12 (n+\lambda) v^2$, and put in Eq. 5:
#
# $$ L(0) - L(v) = \frac12\,\frac{\left(\sum e_i\right)^2}{n + \lambda}. \tag{6} $$
#
# A question splits the flights into a left and a right branch. The best question is the one for which the sum of Eq. 6
# over both branches is largest. We try all thresholds halfway between two neighbouring values of $x$.


# %%
def best_stump(x, error, penalty=1.0):
    """The best threshold, and the corrections left and right of it (Eqs 5 and 6)."""
    levels = np.unique(x)
    best_gain = -np.inf
    for threshold in (levels[:-1] + levels[1:]) / 2:
        left, right = error[x < threshold], error[x >= threshold]
        gain = left.sum() ** 2 / (len(left) + penalty) + right.sum() ** 2 / (len(right) + penalty)
        if gain > best_gain:
            best_gain = gain
            stump = threshold, left.sum() / (len(left) + penalty), right.sum() / (len(right) + penalty)
    return stump


# %% [markdown]
# The first prediction is the mean of $y$. Each round fits a stump to the errors, and adds only a share of it, the
# *learning rate* 0.3. Forty flights are enough to see it (`exact` tells the library to try all thresholds, as we do):

# %%
sample = np.random.default_rng(0).choice(len(hours), 40, replace=False)
x, y = hours.wind_speed.to_numpy()[sample], np.log(offsets[sample])
by_hand = [np.full(len(y), y.mean())]
for _ in range(2):
    threshold, left, right_value = best_stump(x, y - by_hand[-1])
    by_hand.append(by_hand[-1] + 0.3 * np.where(x < threshold, left, right_value))
    print(f"below {threshold:.2f} m/s add 0.3 · {left:.3f}, else add 0.3 · {right_value:.3f}")

library = XGBRegressor(n_estimators=2, max_depth=1, learning_rate=0.3, reg_lambda=1.0, tree_method="exact")
library.fit(x[:, None], y)
print(f"largest difference to XGBoost: {abs(library.predict(x[:, None]) - by_hand[-1]).max():.0e}")

# %% tags=["check"]
assert abs(library.predict(x[:, None]) - by_hand[-1]).max() < 1e-6
for rounds in (1, 2):
    assert np.allclose(library.predict(x[:, None], iteration_range=(0, rounds)), by_hand[rounds], atol=1e-6)
squares = [((y - said) ** 2).sum() for said in by_hand]
assert squares[0] > squares[1] > squares[2]

# %% tags=["figure"]
grid = np.linspace(0, x.max(), 400)
more = XGBRegressor(n_estimators=30, max_depth=1, learning_rate=0.3, tree_method="exact").fit(x[:, None], y)
steps = {
    f"{n} round{'s' * (n > 1)}": np.exp(more.predict(grid[:, None], iteration_range=(0, n)).astype(float))
    for n in (1, 2, 30)
}
before = "before the first round"
figure = plot.lines(grid, {before: np.full(400, np.exp(y.mean())), **steps}, "wind speed [m/s]", "offset ξ [m]",
                    points={"40 flights": np.column_stack([x, np.exp(y)])}, log="y", title="boosting: steps on steps",
                    colors={"40 flights": "0.3", before: plot.GREEN, "1 round": plot.PINK, "2 rounds": plot.BLUE,
                            "30 rounds": plot.ORANGE})  # fmt: skip
figure.axes[0].set_yticks([0.4, 0.6, 1, 1.5, 2, 3], ["0.4", "0.6", "1", "1.5", "2", "3"])
figure

# %% [markdown]
# *The prediction before the first round, and after 1, 2 and 30 rounds of stumps.* After 30 rounds the steps follow the
# flights.
#
# XGBoost's full model differs in two ways. First, its trees ask up to six questions in a row, about any feature.
# Second, each round makes a tree for each class. For a flight, $u_j$ is the sum of what the trees of class $j$ say,
# and $p_j = \exp(u_j)/\sum_k \exp(u_k)$ is the probability of the class.
#
# What is the error now? In Eq. 4 it was minus the derivative of $\tfrac12(y - \hat y)^2$ with respect to $\hat y$. In
# place of this square stands $-\ln p_c = -u_c + \ln\sum_k \exp(u_k)$, where $c$ is the true class. Minus its derivative
# with respect to $u_j$ is $1 - p_j$ for $j = c$, and $0 - p_j$ otherwise. (Chen and Guestrin, in *Read on*, derive what
# takes the place of $n$.) By default there are 100 rounds, so 600 trees.

# %% tags=["check"]
assert len(model.get_booster().get_dump()) == 600

# %% [markdown]
# > **Predict first.** The more rounds, the higher is the accuracy on the flights that the model learns from. Does it
# > also rise on new flights?

# %%
longer = XGBClassifier(n_estimators=300, n_jobs=1, random_state=0).fit(learn_x, learn_j - 1)
rounds = np.array([1, 2, 3, 5, 8, 12, 20, 30, 50, 100, 200, 300])
learned, tested = (
    [(1 + longer.predict(x_part, iteration_range=(0, n)) == j_part).mean() for n in rounds]
    for x_part, j_part in ((learn_x, learn_j), (test_x, test_j))
)
for n in (20, 100, 300):
    i = list(rounds).index(n)
    print(f"{n:3d} rounds: {learned[i]:.1%} on flights it learned from, {tested[i]:.1%} on new ones")
few, many = (1 + longer.predict(test_x, iteration_range=(0, n)) == test_j for n in (20, 300))
change = 100 * (few.astype(float) - many)
print(f"lost from 20 to 300: {change.mean():.1f} ± {1.96 * change.std() / np.sqrt(len(change)):.1f} points")

# %% tags=["check"]
by_round = dict(zip(rounds.tolist(), zip(learned, tested, strict=True), strict=True))
assert abs(by_round[300][0] - 0.997) < 0.002
assert by_round[20][1] > by_round[100][1] > by_round[300][1] - 0.005
assert abs(change.mean() - 2.6) < 0.8
assert 1.0 < 1.96 * change.std() / np.sqrt(len(change)) < 1.8

# %% tags=["figure"]
spread = np.array([share_interval(round(share * len(test_j)), len(test_j)) for share in tested]).T
plot.lines(rounds, {"flights it learned from": 100 * np.array(learned), "new flights": 100 * np.array(tested)},
           "rounds of boosting", "accuracy [%]", bands={"new flights": tuple(100 * spread)}, band_label="95 %", log="x",
           y_range=(60, 100), places={"default": 100.0}, title="learning by heart",
           colors={"flights it learned from": plot.PINK, "new flights": plot.ORANGE})  # fmt: skip

# %% [markdown]
# *The accuracy on flights to learn from and on new ones, over the number of rounds.* On known flights the accuracy
# climbs to 99.7 %. On new ones it falls from 20 to 300 rounds by 2.6 ± 1.6 points: the model learns the noise of single
# flights by heart. This is called *overfitting*. **The accuracy on known flights doesn't say how good a model is.**
#
# ## Four models
#
# We test REPARE's three models and a fourth, each with its library's default settings, on the same five random
# splits.

# %%
models = {
    "Ridge": Ridge(),
    "GaussianNB": GaussianNB(),
    "Random forest": RandomForestClassifier(random_state=0),
    "XGBClassifier": XGBClassifier(n_jobs=1, random_state=0),
}
accuracy = {name: [] for name in models}
for seed in range(5):
    learn, test = train_test_split(np.arange(len(hours)), test_size=0.2, random_state=seed)
    for name, one in models.items():
        said = one.fit(features.iloc[learn], classes[learn] - 1).predict(features.iloc[test])
        accuracy[name].append((1 + np.clip(np.rint(said), 0, 5) == classes[test]).mean())

# %%
for name, shares in accuracy.items():
    print(f"{name:<14} {np.mean(shares):.1%} on average, {min(shares):.1%} to {max(shares):.1%}")

# %% tags=["check"]
average = {name: np.mean(shares) for name, shares in accuracy.items()}
for name, expected in (("Ridge", 0.61), ("GaussianNB", 0.59), ("Random forest", 0.73), ("XGBClassifier", 0.74)):
    assert abs(average[name] - expected) < 0.012, average
assert max(*accuracy["Ridge"], *accuracy["GaussianNB"]) < min(*accuracy["Random forest"], *accuracy["XGBClassifier"])

# %% [markdown]
# | model | how it names a class | REPARE [%] | ours [%] |
# |---|---|---|---|
# | Ridge | linear regression, with a penalty on large coefficients; we round its value to a class | 9.424 | 61 |
# | GaussianNB | takes each feature for normal and independent within a class, and names the most probable class | 59.426 | 59 |
# | XGBClassifier | see above | 72.852 | 74 |
# | Random forest | (not in the paper) 100 large trees, each grown on a random choice of the data; their probabilities are averaged | – | 73 |
#
# GaussianNB and XGBClassifier come out near the paper because we tuned for it. Ridge comes out far above; we don't know
# why.
#
# ## Leakage: how an accuracy pretends
#
# So far we tested on random *hours*, and every flight had its own noise. Real flights of one day share some: the pilot,
# the battery, a front that makes the air rough all day. So let a part of the noise, with standard deviation 0.19 (our
# choice), be drawn once a day. Variances add up, so $\sqrt{0.21^2 - 0.19^2} = 0.09$ is left for each flight.
#
# We deal the flights into three parts, and predict each by a model of the other two (60 rounds, to save time). Either
# the parts are random hours (*shuffled hours*), or random days with all their hours (*whole days*; `GroupKFold` keeps
# them together).
#
# > **Predict first.** Which test gives the higher accuracy when a day shares nothing, and which when it shares most
# > of the noise?


# %%
def day_noise(shared, seed):
    """Factors of the offsets when the flights of a day share a part of the noise."""
    rng = np.random.default_rng(seed)
    own = np.sqrt(0.21**2 - shared**2)
    return np.exp(shared * rng.standard_normal(365)[day] + own * rng.standard_normal(len(hours)))


def two_tests(columns, shared, seed):
    """Accuracy [%] on shuffled hours, and on whole days."""
    flown, found = np.clip(np.ceil(typical * day_noise(shared, seed)), 1, 6), []
    fresh = XGBClassifier(n_estimators=60, n_jobs=1, random_state=0)
    for parts, together in ((KFold, None), (GroupKFold, day)):
        split = parts(3, shuffle=True, random_state=seed)
        said = cross_val_predict(fresh, columns, flown - 1, groups=together, cv=split)
        found.append(100 * (said + 1 == flown).mean())
    return found


# %%
def with_interval(values):
    """The mean of a few runs, and how far its 95 % interval reaches to each side."""
    reach = t.ppf(0.975, len(values) - 1)  # Student's t: 3.2 for four runs, where many runs have 1.96
    return np.mean(values), reach * np.std(values, ddof=1) / np.sqrt(len(values))


# %%
tests = {shared: np.array([two_tests(features, shared, seed) for seed in range(4)]) for shared in (0.0, 0.19)}
for shared, found in tests.items():
    hourly, daily = found.mean(axis=0)
    gap, reach = with_interval(found[:, 0] - found[:, 1])
    print(f"shared {shared:.2f}: shuffled hours {hourly:.1f} %, whole days {daily:.1f} %; ", end="")
    print(f"difference {gap:.1f} ± {reach:.1f} points")

# %% tags=["check"]
means = {shared: found.mean(axis=0) for shared, found in tests.items()}
assert abs(means[0.0][0] - means[0.0][1]) < 0.5
assert abs(means[0.19] - (76.6, 73.8)).max() < 0.6
assert abs(gap - 2.8) < 0.4
assert reach < 0.8

# %% tags=["figure"]
table = {
    name: {
        row: (middle, middle - half, middle + half)
        for row, (middle, half) in zip(
            ("shuffled hours", "whole days"), map(with_interval, tests[shared].T), strict=True
        )
    }
    for name, shared in (("a fresh noise for each flight", 0.0), ("a noise mostly shared by a day", 0.19))
}
plot.intervals(table, "accuracy [%]", digits=1, x_range=(71, 79), title="the same model, tested in two ways",
               colors=dict(zip(table, (plot.BLUE, plot.ORANGE), strict=True)))  # fmt: skip

# %% [markdown]
# *Means over four draws of the noise, with 95 % intervals.* The draws differ, and so the intervals are wide and
# overlap. But in the same draw, shuffled hours promise 2.8 ± 0.4 points more than whole days give, if the noise is
# shared. The model has learned from other hours of the same day, with similar weather and the same noise. Of tomorrow
# it knows none. This is *leakage*: the test knows something that the future won't know.
#
# > **Try it.** Add a column with the date, so that the model can learn the seasons. Does it leak more or less?

# %% tags=["try-it"]
dated = features.assign(date=np.arange(len(hours)) / 24)
print("shuffled hours, whole days, with the date:   ", np.round(two_tests(dated, 0.19, 0), 1))
print("shuffled hours, whole days, without the date:", tests[0.19][0].round(1))

# %% [markdown]
# More: on average of two draws 4.0 points, and 2.8 without the date.
#
# From here on, new flights are always whole days: every fifth day of the year is *new*. And a new *place*? Here is a
# street at a right angle to ours, in the same weather:

# %%
new = day % 5 == 0  # 1752 flights
old = ~new
classifier = XGBClassifier(n_jobs=1, random_state=0).fit(features[old], classes[old] - 1)
likely = 1 + classifier.predict(features[new])
elsewhere = np.clip(np.ceil(typical_offset(features, uav, street_deg=150.0) * noise), 1, 6)[new]
print(f"our street:   accuracy {(likely == classes[new]).mean():.0%}")
print(f"other street: accuracy {(likely == elsewhere).mean():.0%}; ", end="")
print(f'always "class 1" {(elsewhere == 1).mean():.0%}')

# %% tags=["check"]
assert new.sum() == 1752
assert abs((likely == elsewhere).mean() - 0.43) < 0.015
assert abs((elsewhere == 1).mean() - 0.53) < 0.005
seasons = [np.subtract(*two_tests(features.assign(date=np.arange(8760) / 24), 0.19, seed)) for seed in range(2)]
assert abs(np.mean(seasons) - 4.0) < 0.3
assert abs(np.subtract(*tests[0.19][:2].T).mean() - 2.8) < 0.3
assert np.all(seasons > np.subtract(*tests[0.19][:2].T))

# %% [markdown]
# There, always saying "class 1" is better: the model has learned the direction of *our* street. **Test on what will
# be new: new days if you fly on new days, new places if you fly to new places.**
#
# ## Which features matter?
#
# Shuffle one column of the test, so that each flight gets, say, the temperature of another flight. If the accuracy
# falls, the model needs that column. The fall is called *permutation importance*. Each fifth of the days is new in
# turn, and each column is shuffled three times.

# %%
falls = []
for fifth in range(5):
    out = day % 5 == fifth
    fitted = XGBClassifier(n_jobs=1, random_state=0).fit(features[~out], classes[~out] - 1)
    found = permutation_importance(fitted, features[out], classes[out] - 1, n_repeats=3, random_state=0)
    falls.append(100 * found.importances_mean)
fall = {name: with_interval(values) for name, values in zip(FEATURES, np.transpose(falls), strict=True)}

# %%
mixed = np.random.default_rng(0).permutation(features["wind_from_deg"][new])
turned = features[new].assign(wind_from_deg=mixed)
lost = {}
for name, one in {"Ridge": Ridge(), "GaussianNB": GaussianNB()}.items():
    one.fit(features[old], classes[old] - 1)
    said = [1 + np.clip(np.rint(one.predict(table)), 0, 5) for table in (features[new], turned)]
    lost[name] = 100 * ((said[0] == classes[new]).mean() - (said[1] == classes[new]).mean())
    print(f"{name} loses {lost[name]:.1f} points without the wind direction")
thick = air_density(features["temperature_c"], features["humidity_percent"], features["pressure_hpa"])
low, high = np.quantile(thick, [0.05, 0.95]) / thick.mean() - 1
print(f"density of the air in 90 % of the hours: {low:+.0%} to {high:+.0%} of its mean")

# %% tags=["check"]
assert abs(fall["wind_speed"][0] - 33) < 2
assert abs(fall["wind_from_deg"][0] - 17.6) < 1.5
assert fall["radiation"][0] > fall["radiation"][1]
assert all(fall[name][0] < 1.2 for name in FEATURES[:3])
assert abs(np.quantile(thick, [0.05, 0.95]) / thick.mean() - 1).max() < 0.08
assert abs(lost["Ridge"] - 7) < 1.5
assert lost["GaussianNB"] < 1

# %% tags=["figure"]
rows = {
    "wind_speed": "wind speed", "wind_from_deg": "wind direction", "radiation": "solar radiation",
    "temperature_c": "temperature", "humidity_percent": "humidity", "pressure_hpa": "pressure",
}  # fmt: skip
bars = {label: (fall[name][0], fall[name][0] - fall[name][1], sum(fall[name])) for name, label in rows.items()}
plot.intervals({"XGBClassifier": bars}, "accuracy lost when the column is shuffled [percentage points]", digits=1,
               title="what the model needs", colors={"XGBClassifier": plot.ORANGE})  # fmt: skip

# %% [markdown]
# *The accuracy that is lost when one column is shuffled: mean of five tests, with its 95 % interval* (a little too
# narrow, since the models share flights). Wind speed and direction carry nearly everything. The trees use the direction
# best: Ridge loses only 7 points without it, and GaussianNB none. Temperature, humidity and pressure change the force
# through the density of the air, by at most 8 % in 90 % of the hours, which the noise hides.
#
# A small loss doesn't prove that a feature has no effect: without the radiation, the model still sees the temperature
# and the wind, which follow the sun.
#
# ## How good can a model be?
#
# Would a better model get all classes right? From Eq. 3 we know the probability of each class. An offset is at most
# $j$ metres if $\ln\tilde\xi + s\,\varepsilon \le \ln j$, so
#
# $$ P(\xi \le j) = \Phi\!\left(\frac{\ln j - \ln\tilde\xi}{s}\right), \qquad
#    p_j = P(\xi \le j) - P(\xi \le j - 1). \tag{7} $$
#
# Here $\Phi$ is the normal distribution function. Class 1 begins at 0, and class 6 takes all the rest. For typical
# offsets of 1.5 and 2.0 m:


# %%
def chances(median, s=0.21):
    """Probability of each of the six classes, a row for each median offset (Eq. 7)."""
    up_to = norm.cdf((np.log([1, 2, 3, 4, 5]) - np.log(np.atleast_1d(median))[:, None]) / s)
    return np.diff(up_to, prepend=0.0, append=1.0, axis=1)


print(chances([1.5, 2.0]).round(2))

# %% tags=["check"]
assert np.allclose(chances(typical), prediction.class_probabilities(np.log(typical), 0.21))
assert abs(chances(1.5)[0].max() - 0.89) < 0.005
assert abs(chances(2.0)[0].max() - 0.50) < 0.005

# %% [markdown]
# For 1.5 m "class 2" is right in 89 % of such flights. For 2.0 m, whatever we say, we are wrong at least half of the
# time. No model can do better, because the noise isn't in the features. The best answer in each hour is the class with
# the largest probability. The mean of these probabilities is the **Bayes limit**.

# %%
limit = chances(typical).max(axis=1).mean()
print(f"Bayes limit: {limit:.1%} of all hours of the year")

# %% tags=["check"]
assert np.isclose(limit, prediction.bayes_accuracy(np.log(typical), 0.21))
assert abs(limit - 0.778) < 0.0006

# %% [markdown]
# > **Try it.** The noise $s = 0.21$ was tuned. What would the limit be for a steadier UAV with $s = 0.1$?

# %% tags=["try-it"]
print(f"Bayes limit with s = 0.1: {chances(typical, s=0.1).max(axis=1).mean():.1%}")

# %% [markdown]
# XGBClassifier is wrong in 26 %, the best possible model in 22 %. Can we get the 4 points between? Rounding up to
# classes throws information away: 2.01 m and 2.99 m become the same. So a *regression* learns $\ln\xi$ itself; its
# prediction takes the place of $\ln\tilde\xi$ in Eq. 7. For $s$ we take the standard deviation of its errors on days
# that it hasn't learned from.
#
# Which settings? The choice may not see the new days. So we compare nine on the *old* days alone. We deal these into
# four parts; `cross_val_predict` predicts each part by a model of the other three. (Our choice for all: a small
# learning rate, and each tree sees a random 80 % of the flights.)

# %%
y_old = np.log(offsets[old])
four_parts = {"cv": GroupKFold(4), "groups": day[old]}
STEPS = {"learning_rate": 0.08, "subsample": 0.8, "n_jobs": 1, "random_state": 0}
for depth in (2, 4, 6):
    for count in (50, 150, 300):
        trees = XGBRegressor(max_depth=depth, n_estimators=count, **STEPS)
        left_over = np.std(y_old - cross_val_predict(trees, features[old], y_old, **four_parts))
        print(f"{depth} questions, {count:3d} rounds: {left_over:.3f}", end="\n" if count == 300 else ";  ")

# %% [markdown]
# Four questions and 150 rounds leave the smallest error, hardly more than the noise of 0.21. Now the test: each fifth
# of the days is new in turn. (The choice has seen four of them; on the first alone the regression does as well.)

# %%
SMALL = {"max_depth": 4, "n_estimators": 150, **STEPS}
fifths = {"cv": PredefinedSplit(day % 5)}  # which fifth each flight belongs to
default = cross_val_predict(XGBClassifier(n_jobs=1), features, classes - 1, method="predict_proba", **fifths)
log_guess = cross_val_predict(XGBRegressor(**SMALL), features, np.log(offsets), **fifths).astype(float)
s_found = np.std(np.log(offsets) - log_guess)
for name, p in {"XGBClassifier": default, "regression of ln ξ": chances(np.exp(log_guess), s_found)}.items():
    named = p.argmax(axis=1)
    expected = chances(typical)[np.arange(len(hours)), named].mean()
    print(f"{name:<18} right in {(named + 1 == classes).mean():.1%}, to be expected {expected:.1%}")
print(f"s of the regression: {s_found:.3f}; Bayes limit {limit:.1%}")

# %% tags=["check"]
gaps = [
    100 * (limit - chances(typical)[np.arange(8760), p.argmax(axis=1)].mean())
    for p in (default, chances(np.exp(log_guess), s_found))
]
assert abs(gaps[0] - 3.7) < 0.4
assert abs(gaps[1] - 0.6) < 0.3
assert 0.21 < s_found < 0.225
of_first = chances(np.exp(log_guess[new]), s_found).argmax(axis=1)
best_first, chosen = chances(typical[new]).max(axis=1), chances(typical[new])[np.arange(1752), of_first]
assert abs(100 * (best_first - chosen).mean() - gaps[1]) < 0.25

# %% [markdown]
# The second column is the mean probability of the named classes, by Eq. 7 with the simulator's own $\tilde\xi$. By it
# XGBClassifier lies 3.7 points below the limit, and the regression only 0.6. But Eq. 7 is exactly how our simulator
# makes its noise; real errors may have another shape.
#
# ## Can we believe the probabilities?
#
# If a model says "70 %" a hundred times, the thing should happen about seventy times. Such probabilities are called
# *calibrated*. We ask "will the offset exceed 1 m?", sort all flights by the predicted probability into ten bins, and
# count in each bin how often it happened.


# %%
def reliability(p, happened):
    """For each tenth of probability: its mean, how often it happened, and the 95 % interval of that."""
    tenth = np.minimum((10 * p).astype(int), 9)
    rows = []
    for i in range(10):
        count, total = int(happened[tenth == i].sum()), int((tenth == i).sum())
        rows.append((p[tenth == i].mean(), count / total, *share_interval(count, total)))
    return np.array(rows)


# %%
exceeds = offsets > 1.0
of_classifier = reliability(1 - default[:, 0], exceeds)
of_regression = reliability(1 - norm.cdf(-log_guess / s_found), exceeds)  # Eq. 7 with ln 1 = 0
for name, found in {"XGBClassifier": of_classifier, "regression": of_regression}.items():
    for said, happened, low, high in found[[1, 8]]:
        print(f"{name} says {said:.0%}, it happens in {happened:.0%} [{low:.0%}, {high:.0%}]")
    reached = ((found[:, 2] <= found[:, 0]) & (found[:, 0] <= found[:, 3])).sum()
    print(f"{name}: the interval holds what was said in {reached} of 10 bins")

# %% tags=["check"]
held = [((f[:, 2] <= f[:, 0]) & (f[:, 0] <= f[:, 3])).sum() for f in (of_classifier, of_regression)]
assert held[0] <= 5
assert held[1] >= 9

# %% tags=["figure"]
figure, axes = plot.new_figure(5.6, 4.8)
axes.plot([0, 1], [0, 1], color="0.5", linestyle=":", label="calibrated")
for name, found, color, marker in (
    ("XGBClassifier", of_classifier, plot.ORANGE, "s"),
    ("regression of ln ξ", of_regression, plot.BLUE, "o"),
):
    reach = np.abs(found[:, 2:].T - found[:, 1])
    axes.errorbar(
        found[:, 0], found[:, 1], reach, color=color, marker=marker, capsize=3, label=f"{name}, 95 % interval"
    )
axes.set(xlabel="predicted probability of more than 1 m", ylabel="share of flights with more than 1 m", aspect="equal",
         title="what is said, and what happens")  # fmt: skip
axes.legend()
plot.finished(figure)

# %% [markdown]
# *A reliability diagram: the observed share of flights over the predicted probability.* XGBClassifier is
# *overconfident*: surer than it should be, in both directions. The regression keeps its word.
#
# ## Which distance to fly with
#
# REPARE's planner keeps $D_\text{min} = \xi + r$, with the body radius $r = D_\text{uav}/2 = 0.5$ m. Which $\xi$?
#
# > **Predict first.** Let $\xi$ be the most likely class. In how many of a hundred flights is the UAV pushed further
# > than that?
#
# The most likely class treats "too low" and "too high" alike. We ask instead for the offset that is *not exceeded with
# a probability of 95 %*, the 95 % quantile. On days left out, the errors $e_i = \ln\xi_i - \hat y_i$ of the regression
# have a 95 % quantile $e_{95}$. So we predict $\hat y$ for tomorrow, and keep
#
# $$ \xi_{95} = \exp(\hat y + e_{95}). \tag{8} $$
#
# This assumes that the errors scatter alike in all weathers, as ours do. (A margin from errors on data left out is the
# idea of *conformal prediction*.)

# %%
regression = XGBRegressor(**SMALL)
errors = y_old - cross_val_predict(regression, features[old], y_old, **four_parts)
guess = regression.fit(features[old], y_old).predict(features[new]).astype(float)
e95 = np.quantile(errors, 0.95)
bound, pushed = np.exp(guess + e95), offsets[new]
print(f"e95 = {e95:.2f}: we keep {np.exp(e95):.2f} times the predicted offset")

# %% [markdown]
# We compare four rules on the 1752 flights of the new days, and a fifth that knows the simulator's own $\tilde\xi$ and
# $s$. We count in metres: a flight that is pushed by 9 m *is* of class 6, which is open, and yet goes 3 m beyond the 6
# m that were kept.

# %%
rules = {
    "most likely class": likely,
    "95 %, to the centimetre": bound,
    "95 %, rounded up, at most 6": np.minimum(np.ceil(bound), 6),
    "95 %, rounded up": np.ceil(bound),
    "95 %, by Eq. 3 itself": typical[new] * np.exp(0.21 * norm.ppf(0.95)),
}
for name, kept in rules.items():
    beyond = pushed > kept
    low, high = share_interval(int(beyond.sum()), len(beyond))
    print(f"{name:<28} mean D_min {kept.mean() + 0.5:.2f} m, ", end="")
    print(f"exceeded in {beyond.mean():5.1%} [{low:.1%}, {high:.1%}]")

# %% tags=["check"]
assert np.isclose(regression.learning_rate, 0.08)
found = {name: (kept.mean() + 0.5, (pushed > kept).mean()) for name, kept in rules.items()}
for name, room, share in (
    ("most likely class", 2.53, 0.184), ("95 %, to the centimetre", 2.83, 0.047),
    ("95 %, rounded up, at most 6", 3.16, 0.037), ("95 %, rounded up", 3.32, 0.009),
):  # fmt: skip
    assert abs(found[name][0] - room) < 0.03, found
    assert abs(found[name][1] - share) < 0.012, found
assert 3 < found["95 %, rounded up, at most 6"][1] / found["95 %, rounded up"][1] < 5
assert np.std(y_old - regression.predict(features[old])) < 0.95 * np.std(errors)
assert abs(found["95 %, by Eq. 3 itself"][0] - 2.80) < 0.01

# %% [markdown]
# The most likely class is exceeded by 18 flights in a hundred. The 95 % quantile keeps 30 cm more on average, and is
# exceeded about as rarely as we asked. A better model could hardly do it for less: Eq. 3 itself keeps 2.80 m.
#
# Rounding up to whole metres, as REPARE does, costs another 50 cm and turns the 95 % into 99 %. And "at most 6" is
# exceeded four times as often as the same rule without an end. **An open class promises nothing.**
#
# The slider sets another quantile than 95 %:

# %% tags=["figure"]
QUANTILES = [50, 60, 70, 80, 90, 95, 98, 99.5]
exact = {q: np.exp(guess + np.quantile(errors, q / 100)) for q in QUANTILES}


def price(kept):
    """Where a rule stands: flights beyond [%], mean D_min [m]."""
    return 100 * (pushed > kept).mean(), kept.mean() + 0.5


# %% tags=["figure"]
def draw_flights(axes, kept):
    """Every new flight, within or beyond what is kept."""
    beyond, ticks = pushed > kept, [0.5, 1, 2, 5, 10]
    for inside, color, name in ((~beyond, "0.6", "within"), (beyond, plot.ORANGE, "beyond")):
        axes.plot(np.exp(guess)[inside], pushed[inside], ".", color=color, markersize=3, label=name)
    ends = np.exp([guess.min(), guess.max()])
    axes.plot(ends, ends * kept[0] / np.exp(guess[0]), color=plot.BLUE, label="kept ξ")
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="predicted offset exp(ŷ) [m], logarithmic",
        ylabel="offset ξ of the flight [m], logarithmic",
        title=f"{price(kept)[0]:.1f} % of 1752 flights beyond",
    )
    axes.set_xticks(ticks, map(str, ticks))
    axes.set_yticks(ticks, map(str, ticks))


# %% tags=["figure"]
def draw_prices(axes, kept):
    """What safety costs by each rule; the mark is what is kept."""
    rounded = [np.ceil(bound) for bound in exact.values()]
    for name, bounds, color in (
        ("quantile, to the centimetre", exact.values(), plot.BLUE),
        ("quantile, rounded up", rounded, plot.GREEN),
    ):
        axes.plot(*np.transpose([price(bound) for bound in bounds]), color=color, marker=".", label=name)
    for q in (50, 70, 80, 90, 95, 99.5):
        axes.annotate(f"{q} %", price(exact[q]), xytext=(-6, -12), textcoords="offset points", ha="right", fontsize=8)
    axes.plot(*price(likely), "D", color=plot.PINK, label="most likely class")
    axes.plot(*price(kept), "o", color=plot.BLUE, markersize=11, label="where the slider stands")
    axes.set(xlabel="flights beyond [%]", ylabel="mean distance to keep D_min [m]", xlim=(-10, 58), ylim=(1.8, 4.2),
             title=f"mean D_min {price(kept)[1]:.2f} m")  # fmt: skip


# %% tags=["figure"]
def turn(quantile):
    """All new flights, and the price of this quantile among the others."""
    figure, panels = plot.new_panels(1, 2, width=9.6, height=4.4)
    for axes, draw in zip(panels, (draw_flights, draw_prices), strict=True):
        draw(axes, exact[quantile])
        axes.legend(fontsize=8)
    return figure


plot.sliders(turn, title="what safety costs", labels={"quantile": "quantile [%]"}, start={"quantile": 95},
             progress=False, quantile=QUANTILES)  # fmt: skip

# %% tags=["check"]
room = {q: price(exact[q])[1] for q in QUANTILES}
assert 0.7 < (room[99.5] - room[95]) / (room[90] - room[50]) < 1.4
curve = np.array([price(exact[q]) for q in QUANTILES])
assert abs(np.interp(-price(likely)[0], -curve[:, 0], curve[:, 1]) - price(likely)[1]) < 0.05

# %% [markdown]
# *Left: the flights of the new days; the column at 0.5 m is the calm hours. Right: the mean distance to keep over the
# share of flights that exceed it, with the quantile at some points.* From 95 to 99.5 % costs about as much as from 50
# to 90 %. The green curve lies above the blue one: for the same share beyond, rounding costs metres. The most likely
# class lies on the blue curve; but nobody chose its 18 %.
#
# Do the quantiles keep their word on other days, too? Each fifth of the days is new in turn:

# %%
CHECKED = (0.80, 0.95)
missed = {q: [] for q in CHECKED}
for fifth in range(5):
    out = day % 5 == fifth
    known = {"X": features[~out], "y": np.log(offsets[~out])}
    error = known["y"] - cross_val_predict(regression, **known, cv=GroupKFold(4), groups=day[~out])
    said = XGBRegressor(**SMALL).fit(**known).predict(features[out])
    for q in CHECKED:
        missed[q].append(100 * (offsets[out] > np.exp(said + np.quantile(error, q))).mean())

# %%
for q in CHECKED:
    middle, reach = with_interval(missed[q])
    print(f"{q:.0%} quantile: {np.round(missed[q], 1)} % beyond, mean {middle:.1f} ± {reach:.1f} %")
low, high = share_interval(round(missed[0.80][0] / 100 * 1752), 1752)
print(f"80 % quantile on our new days alone: 95 % interval from {low:.1%} to {high:.1%}")

# %% tags=["check"]
assert abs(np.mean(missed[0.80]) - 19.9) < 1
assert abs(np.mean(missed[0.95]) - 4.9) < 0.5
first = (missed[0.80][0] / 100, *share_interval(round(missed[0.80][0] / 100 * 1752), 1752))
assert np.allclose(first, (0.226, 0.207, 0.246), atol=0.003)
sizes = [(day % 5 == fifth).sum() for fifth in range(5)]
ends = [share_interval(round(m / 100 * n), int(n)) for q in CHECKED for m, n in zip(missed[q], sizes, strict=True)]
assert [low <= 1 - q <= high for q, (low, high) in zip(np.repeat(CHECKED, 5), ends, strict=True)] == [False] + 9 * [
    True
]
assert abs(missed[0.80][0] - 100 * (pushed > exact[80]).mean()) < 1e-9

# %% [markdown]
# On average they do, at 80 % and at 95 %. On our own new days the 80 % quantile doesn't: 22.6 % go beyond it, and the
# interval [20.7, 24.6] excludes 20 %. Of the ten such intervals (five parts, two quantiles) it is the only one that
# misses. It may be luck, but a single set of 73 days can be off by two or three points.
#
# The 95 % are our choice, and count flights. (The 99.73 % of chapter 02 count moments on one axis.)
#
# ## Tomorrow
#
# `OffsetPredictor` is the library's form of what we built: the same regression and quantile, rounded up to whole
# metres. With `groups=day[old]` it measures the errors on whole days that were left out. Its last class, too, is open;
# with 20 classes it is out of reach. Tomorrow is 22 March, one of the new days, in the middle of a street of 13 m (our
# choice). So the UAV may fly while $D_\text{min}$ is at most 6.5 m. A real tomorrow is harder: here the weather is measured, and
# the predictor knows 23 March.

# %%
predictor = OffsetPredictor(class_count=20).fit(features[old], offsets[old], groups=day[old])
tomorrow = features[day == 80]
keep = minimum_safe_distance(predictor.predict_offset(tomorrow), uav.diameter)
for hour in (1, 7, 10, 12, 14, 18, 21):
    verdict = "fly" if keep[hour - 1] <= 6.5 else "stay on the ground"
    at = tomorrow.iloc[hour - 1]
    wind = f"wind {at.wind_speed:.1f} m/s from {at.wind_from_deg:.0f}°"
    print(f"hour {hour:2d}: {wind}, D_min {keep[hour - 1]:4.1f} m: {verdict}")

# %%
grounded = np.ceil(bound) + 0.5 > 6.5  # on all new days
aside = abs((features["wind_from_deg"][new] - 60 + 90) % 180 - 90)  # angle between wind and street, 0 to 90°
print(f"on the ground in {grounded.mean():.0%} of the hours; wind within 45° of the street ", end="")
print(f"in {(aside[grounded] <= 45).mean():.0%} of these, in {(aside <= 45).mean():.0%} of all")

# %% tags=["check"]
with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # a few of the new hours are colder than all that it has learned from
    assert np.array_equal(predictor.log_offset(features[new]), guess)
    assert np.array_equal(minimum_safe_distance(predictor.predict_offset(features[new]), uav.diameter) > 6.5, grounded)
assert abs(predictor.training.margin - e95) < 1e-6
assert np.allclose(3 * predictor.predict_sigma(tomorrow), keep - 0.5)
assert abs(grounded.mean() - 0.06) < 0.005
assert abs((aside[grounded] <= 45).mean() - 0.97) < 0.015
assert abs((aside <= 45).mean() - 0.60) < 0.005

# %% [markdown]
# (A planner that asks for $\sigma$ and keeps $3\sigma$ gets $\xi/3$ from `predict_sigma`.) On all new days the rule
# grounds the UAV in 6 % of the hours. In 97 % of these the wind blows within 45° of the street, against 60 % of all
# hours. **So nearly always it grounds the UAV in wind along the street**, where a route along the street has no wall.
# How much of $\xi$ goes across, our data don't say; for that you need offsets measured across the street.
#
# Does `groups` matter? Hardly, where each flight has its own noise. But if a day shares most of it:

# %%
hourly = OffsetPredictor().fit(features[old], offsets[old]).training.margin
print(f"own noise: margin {hourly:.3f} from shuffled hours, {e95:.3f} from whole days")

# %%
beyond = {"shuffled hours": [], "whole days": []}
for seed in range(6):
    flown = typical * day_noise(0.19, seed)
    for name, labels in zip(beyond, (None, day[old]), strict=True):
        margin = OffsetPredictor().fit(features[old], flown[old], groups=labels).training.margin
        said = XGBRegressor(**SMALL).fit(features[old], np.log(flown[old])).predict(features[new])
        beyond[name].append(100 * (flown[new] > np.exp(said + margin)).mean())
for name, shares in beyond.items():
    middle, reach = with_interval(shares)
    print(f"errors measured on {name:<14}: {middle:.1f} ± {reach:.1f} % beyond, asked for 5 %")
gap, reach = with_interval(np.subtract(beyond["shuffled hours"], beyond["whole days"]))
print(f"in the same draw: {gap:.1f} ± {reach:.1f} points between them")

# %% tags=["check"]
assert abs(hourly - e95) < 0.005
assert abs(gap - 1.9) < 0.3
assert abs(reach - 0.5) < 0.2
assert 3.5 < np.mean(beyond["whole days"]) < 5.5

# %% [markdown]
# In the same draw, margins from shuffled hours let 1.9 ± 0.5 points more flights go beyond.
#
# > **Predict first.** The strongest wind of the record has 15.4 m/s. What does the predictor say about 25 m/s?

# %%
storm = tomorrow.iloc[[12]].assign(wind_speed=25.0)
midnight = tomorrow.iloc[[23]].assign(radiation=900.0)
for name, odd in {"storm": storm, "sunny midnight": midnight}.items():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        median = np.exp(predictor.log_offset(odd)[0])
    print(f"{name}: typical offset {median:.1f} m, by Eq. 2 {typical_offset(odd, uav).iloc[0]:.1f} m")
    print("   warning:", caught[0].message if caught else "none")

# %% tags=["check"]
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    assert abs(np.exp(predictor.log_offset(storm)[0]) - 8.6) < 0.5
    assert "wind_speed = 25 is outside of 0 to" in str(caught[0].message)
    predictor.log_offset(midnight)
assert len(caught) == 1
assert abs(typical_offset(storm, uav).iloc[0] - 55) < 1

# %% [markdown]
# By Eq. 2 the UAV is blown away; the predictor says 9 m. The trees put the storm into the branch of the strongest wind
# that they have seen. **Trees don't extrapolate.** The library warns, but not of a new *combination*, such as a sunny
# midnight.
#
# ## Remember
#
# - Test a model on what will be new to it: new days if you fly on new days. Choose its settings without these days.
# - Boosting adds small trees, each fitted to the errors of those before. Too many rounds learn the noise by heart.
# - Noise sets a limit. In our simulator, with the noise that we tuned, it is 77.8 % of the classes.
# - Look at the probabilities, too: a model can be accurate and yet surer than it should be.
# - The most likely class is not the one to fly with. Ask for a quantile, measure its margin on whole days that were left
#   out, count exceedances in metres, and don't trust an open class.
# - Here the weather was measured, not forecast; the offsets were simulated, and have no direction.
#
# ## What the paper says, what we find
#
# | REPARE, section 2.2.3 | says | we find, on simulated offsets |
# |---|---|---|
# | Ridge | 9.424 % "accuracy" | 61 % accuracy |
# | GaussianNB | 59.426 % | 59 %; noise and street were tuned for this and the next figure |
# | XGBClassifier | 72.852 %, the best of the three | 74 %, the best of the three in all five splits; 3.7 points below the limit |
# | the test | 1466 samples at random | random hours promise 2.8 points too much if a day shares most of the noise; whether the paper's flights share a day, the text that we have doesn't say |
# | the distance | "determined by rounding up" | on new days the most likely class is exceeded by 18 % of the flights; the 95 % quantile by about 5 % |
#
# None of the paper's three figures is a share of 1466 samples. How they were computed, the text that we have doesn't
# say.

# %% tags=["check"]
for percent in (9.424, 59.426, 72.852):
    assert all(round(100 * k / 1466, 3) != percent for k in range(1467))

# %% [markdown]
# ## Read on
#
# - T. Chen and C. Guestrin, "XGBoost: a scalable tree boosting system", KDD 2016,
#   [doi:10.1145/2939672.2939785](https://doi.org/10.1145/2939672.2939785): our Eqs 4 to 6 in general, and what makes it
#   fast.
# - T. Hastie, R. Tibshirani and J. Friedman, *The Elements of Statistical Learning*, 2nd edition, Springer 2009,
#   [doi:10.1007/978-0-387-84858-7](https://doi.org/10.1007/978-0-387-84858-7): chapters 2 (the Bayes limit), 7 (testing
#   a model) and 10 (boosting).
# - D. R. Roberts and others, "Cross-validation strategies for data with temporal, spatial, hierarchical, or
#   phylogenetic structure", *Ecography* 40 (2017) 913–929,
#   [doi:10.1111/ecog.02881](https://doi.org/10.1111/ecog.02881): leakage, and how to split data that belong together.
# - Y. Romano, E. Patterson and E. Candès, "Conformalized quantile regression", NeurIPS 2019,
#   [arXiv:1905.03222](https://arxiv.org/abs/1905.03222): the quantile of errors on data left out, with a proof, for
#   noise that changes with the weather.
#
# ## Your turn
#
# Six exercises, from a fair test to a rule of your own for noise that changes with the sun:
# [exercises/03_predicting_the_disturbance_exercises.ipynb](exercises/03_predicting_the_disturbance_exercises.ipynb).
#
# Before: [02 The Pauta criterion](02_pauta.ipynb). Next: [04 Cities](04_cities.ipynb).
