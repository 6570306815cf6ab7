# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 03 Predicting the disturbance: from tomorrow's weather to the distance to keep
#
# A planner wants one number before take-off: how far may a gust push the UAV today? The forecast doesn't say; it has
# temperatures and winds. REPARE (Sensors 2022, 22, 2151, [doi:10.3390/s22062151](https://doi.org/10.3390/s22062151),
# section 2.2.3) lets a model learn the step between the two from earlier flights: six features of the weather in, the
# offset as a class out, rounded up. It reports three accuracies, 9.424, 59.426 and 72.852 %, in its Fig. 4. We repeat
# that comparison where we know the truth, find out what the 9.424 can be, and then ask the two questions that the
# paper leaves out: how good could a model be at best, and is the most accurate one the safest?

# %%
import tempfile
import warnings
from pathlib import Path

import numpy as np
from sklearn.metrics import confusion_matrix

from uavlab import plot, prediction
from uavlab.offsets import minimum_safe_distance
from uavlab.prediction import (
    FEATURES,
    PAPER_MODELS,
    OffsetPredictor,
    compare_models,
    make_dataset,
)
from uavlab.vehicle import LIGHT_QUADROTOR
from uavlab.weather import greensboro_weather

# %% [markdown]
# ## Real weather
#
# The six features are temperature, humidity, pressure, wind speed, wind direction and solar radiation. A typical year
# of Greensboro, North Carolina, has all of them, hour by hour:

# %% tags=["nbval-check-output"]
hours = greensboro_weather()
print(f"{len(hours):,} hours, mean wind {hours.wind_speed.mean():.1f} m/s, highest {hours.wind_speed.max():.1f} m/s")
print(f"calm in {(hours.wind_speed == 0).mean():.0%} of the hours")
assert len(hours) == 8760
assert set(FEATURES) <= set(hours.columns)

# %% tags=["figure"]
figure, panels = plot.new_panels(2, 2, height=5.4)
by_hour, colors = hours.groupby((hours.index + 1) % 24), {"radiation": plot.YELLOW, "wind": plot.BLUE}
for axes, values, edges, label in (
    (panels[0], hours.wind_speed, np.arange(0, 17), "wind speed [m/s]"),
    (panels[1], hours.wind_from_deg[hours.wind_speed > 0], np.arange(-5, 366, 10), "wind from [degrees from north]"),
):
    counts, _ = np.histogram(values, edges)
    middles = (edges[:-1] + edges[1:]) / 2
    plot.lines(middles, {"wind": counts}, label, "hours a year", steps=True, colors=colors, axes=axes)
for axes, name, label in ((panels[2], "wind_speed", "wind [m/s]"), (panels[3], "radiation", "radiation [W/m²]")):
    mean = by_hour[name].mean()
    plot.lines(mean.index, {name.split("_")[0]: mean}, "hour of the day", f"{label}, mean", colors=colors, axes=axes)
panels[1].set_xticks([0, 90, 180, 270, 360])
figure

# %% [markdown]
# The wind rises and falls with the sun, so the features are not independent of each other. That will matter.
#
# ## From the weather to an offset
#
# **No offsets were measured.** REPARE's flights are not published, and nobody else's are known to us. So all offsets
# in this course come from a physical model, whether the weather is real or not. It says how things depend on each
# other, not how large they were on one day in one city.
#
# The station's wind $V$ is stronger where the UAV flies, by a factor $h$. It is stronger along the streets and weaker
# across them, by a share $a$; $\theta$ is where it comes from and $\theta_s$ the direction of the streets. Gusts
# exceed the mean by $g$ standard deviations of the turbulence, of intensity $I$. The sun drives turbulence, most of
# all when the wind is light:
#
# $$ I = I_m + I_c\,\frac{Q / 1000\ \mathrm{W/m^2}}{1 + V / V_c}, \tag{1} $$
# $$ V_g = V\, h\,[1 + a \cos 2(\theta - \theta_s)]\,(1 + g\, I). \tag{2} $$
#
# The gust's drag (Eq. 4 of [01 wind and rain](01_wind_and_rain.ipynb)) works against the thrust that the weight $G$
# leaves sideways. The offset is what the strongest gust reaches:
#
# $$ \tilde\xi = \xi_0 + 8.5\ \mathrm m\ \frac{\tfrac12 \rho\, C S\, V_g^2}{\sqrt{T^2 - G^2}}. \tag{3} $$
#
# In the same weather a flight is pushed further one time than the other. The scatter is a factor, so its logarithm is
# taken as normal, with a spread $s$; and the class is the offset in metres, rounded up:
#
# $$ \xi = \tilde\xi\, e^{s\,\varepsilon},\quad \varepsilon \sim N(0, 1), \qquad
#    k = \min(\max(\lceil \xi / \mathrm m \rceil, 1), n). \tag{4} $$
#
# If nothing else is said, $I_m = 0.2$, $I_c = 0.3$, $V_c = 3$ m/s, $h = 1.4$, $a = 0.38$, $\theta_s = 60°$, $g = 2.5$,
# $\xi_0 = 0.5$ m, $s = 0.21$ and $n = 6$ classes. The 8.5 m is chosen so that the distances of REPARE Table 4 come out,
# if "mild" and "heavy" are winds of 6 and 9 m/s with a gust factor of 1.75, and the loads are 250 g and 1 kg (the last
# one only just):

# %% tags=["nbval-check-output"]
table4 = []
for load, wind in ((0.25, 6), (1.0, 6), (0.25, 9)):
    uav = LIGHT_QUADROTOR.loaded(load)
    drag = 0.5 * 1.225 * uav.drag_area * (1.75 * wind) ** 2
    offset = 0.5 + 8.5 * drag / np.sqrt(uav.thrust**2 - uav.weight**2)
    table4.append(minimum_safe_distance(np.ceil(offset), uav.diameter))
    print(f"load {load:.2f} kg, wind {wind} m/s: ξ = {offset:.3f} m, D_min = {table4[-1]:.1f} m")
assert table4 == [3.5, 4.5, 5.5]

# %%
winds = np.linspace(0, 10, 101)
base = {"temperature_c": 15.0, "humidity_percent": 60.0, "pressure_hpa": 985.0, "wind_speed": winds}
medians = {}
for label, angle, sun, level in (
    ("along the streets, sunny", 60.0, 800.0, 5),
    ("along the streets, night", 60.0, 0.0, 4),
    ("across the streets, sunny", 150.0, 800.0, 2),
):
    weather = {name: np.broadcast_to(v, winds.shape) for name, v in (base | {"wind_from_deg": angle}).items()}
    medians[label] = prediction.median_offsets(weather | {"radiation": np.full(winds.shape, sun)}, LIGHT_QUADROTOR)
    assert np.ceil(np.interp(5.5, winds, medians[label])) == level
spread_of = {label: (median * np.exp(-0.21), median * np.exp(0.21)) for label, median in medians.items()}
plot.lines(winds, medians, "wind at the station [m/s]", "offset ξ [m], median", bands=spread_of,
           band_label="± one spread", y_range=(0, 7))  # fmt: skip

# %% [markdown]
# The horizontal lines are where the class changes. The median of the same wind, 5.5 m/s, is class 2 or class 5,
# depending on where it comes from.
#
# ## A table to learn from
#
# As in the paper: 7 330 samples, 5 864 to learn from and 1 466 to be tested on. Two of our settings: "paper", with
# made-up weather, and "greensboro", with hours of the real record.

# %% tags=["nbval-check-output"]
tables = {name: make_dataset(name, 0) for name in ("paper", "greensboro")}
for name, data in tables.items():
    shares = np.bincount(data.classes, minlength=7)[1:] / len(data.classes)
    print(f"{name:<10} {data.train.sum()} + {data.test.sum()}  classes 1–6:", *(f"{share:5.1%}" for share in shares))
    assert data.features.shape == (7330, 6)
    assert data.test.sum() == 1466

# %% tags=["figure"]
figure, panels = plot.new_panels(1, 2, share="y", width=9.0)
data = tables["greensboro"]
for axes, name, label, title in (
    (panels[0], "wind_speed", "wind speed [m/s]", "wind speed: a band"),
    (panels[1], "wind_from_deg", "wind from [degrees from north]", "direction: two humps"),
):
    pairs = np.column_stack([data.features[name], data.offsets])[::3]
    by_class = {f"class {k}": pairs[data.classes[::3] == k] for k in range(1, 7)}
    plot.points(by_class, label, "simulated offset [m]", y_range=(0, 9), title=title, axes=axes)
panels[1].set_xticks([0, 60, 150, 240, 330])
figure

# %% [markdown]
# (Colour: the class, dark for 1 and bright for 6 and above.) Two humps over the direction: no straight line can follow
# them, and no single bell curve.
#
# ## REPARE's Fig. 4, repeated
#
# The paper's three models, with the settings that their libraries start with: **Ridge** lays a plane through the class
# numbers. **GaussianNB** takes, within each class, each feature for normal and for independent of the others.
# **XGBClassifier** adds up a hundred small decision trees. Two measures for each: the accuracy, the share of right
# classes (Ridge's values rounded), and
#
# $$ R^2 = 1 - \frac{\sum_i (k_i - \hat k_i)^2}{\sum_i (k_i - \bar k)^2}, \tag{5} $$
#
# the share of the variance that is explained, 0 for a model that always says the mean, and negative for a worse one.
# Eight tables, drawn and split anew each time:

# %%
each = compare_models(range(8), setting="paper", jobs=2, progress=False, each=True)
paper = each.groupby("model", sort=False).mean()
spread = each.groupby("model", sort=False).std()
for name in PAPER_MODELS:
    print(f"{name:<14} accuracy {paper.accuracy[name]:.0%}, R² {paper.r2[name]:.0%}, mean of 8 tables")
assert abs(paper.accuracy["GaussianNB"] - 0.59426) < 0.02
assert abs(paper.accuracy["XGBClassifier"] - 0.72852) < 0.02
assert abs(paper.accuracy["Ridge"] - 0.56) < 0.02
assert paper.r2["Ridge"] > 0.5

# %% tags=["figure"]
T_8 = 2.365  # Student's t for 8 values: 95 % of single runs lie within T_8 √(1 + 1/8) standard deviations
reach = T_8 * np.sqrt(1 + 1 / 8)
printed = {"Ridge": 9.424, "GaussianNB": 59.426, "XGBClassifier": 72.852}


def with_reach(measure):
    """Each model's mean and the ends of its single runs [%]."""
    middle, half = 100 * paper[measure], 100 * reach * spread[measure]
    return {name: (middle[name], middle[name] - half[name], middle[name] + half[name]) for name in printed}


scores = {"REPARE Fig. 4": printed, "ours: accuracy": with_reach("accuracy"), "ours: R²": with_reach("r2")}
plot.intervals(scores, "score [%]", level="95 % (of single runs)", digits=1, x_range=(0, 100))

# %% [markdown]
# GaussianNB and XGBClassifier land where the paper has them. That is no confirmation: we looked for such a setting
# (the noise and the streets' share $a$), to have the same distance to travel. What it does say: the two figures go
# together, with one noise. And Ridge doesn't fit at all: a plane gets more than half of the classes right.
#
# ## What is 9.424 %?
#
# An accuracy on 1 466 samples is a count $k$ divided by 1 466. Which counts do the printed figures belong to?

# %% tags=["nbval-check-output"]
for name, percent in printed.items():
    k = round(percent / 100 * 1466)
    print(f"{name:<14} {percent} % of 1466 = {percent * 14.66:8.3f};  {k}/1466 = {100 * k / 1466:.3f} %")
    assert round(100 * k / 1466, 3) != percent


def is_count(percent, samples):
    """Whether a percentage, rounded or cut to three decimals, can be a share of this many samples."""
    share = 100 * np.ceil((percent - 0.0005) / 100 * samples) / samples  # the least one that isn't below it
    return share < percent + 0.001


sizes = np.arange(2, 7331)
both = sizes[is_count(59.426, sizes) & is_count(72.852, sizes)]
print("smallest test on which GaussianNB's and XGBClassifier's figures are both counts:", both[0])
splits = 1 + np.flatnonzero(is_count(59.426, 1466 * np.arange(1, 100)) & is_count(72.852, 1466 * np.arange(1, 100)))
print("smallest number of splits of which both can be the mean:", splits[0])
assert not set(both) & {1466, 5864, 7330}

# %% [markdown]
# None of the three is a count of 1 466 (XGBClassifier's misses by its last digit only), nor are the two accuracies
# both counts of the 5 864 for training or of all 7 330. Means over many splits can't be ruled out; the paper doesn't
# say.
#
# Ridge stands out for another reason. A model that only ever says the most frequent class does better than 9 %, by
# far. But Ridge is a regression, and the number that its library returns as its *score* is $R^2$. Can an $R^2$ of 9 %
# stand beside accuracies of 59 and 73 %? Only where a plane fails and trees don't. "steady wind" is such a setting:
# flights in a light wind of hardly changing strength (Weibull shape 9 instead of 2), where the direction decides
# ($a = 0.8$), with four classes and more noise ($s = 0.3$):

# %%
steady = compare_models(range(8), setting="steady wind", models=PAPER_MODELS, jobs=2, progress=False, each=True)
steady_mean = steady.groupby("model", sort=False).mean()
steady_reach = reach * steady.groupby("model", sort=False)[["accuracy", "r2"]].std()
for name, measure in (("Ridge", "r2"), ("GaussianNB", "accuracy"), ("XGBClassifier", "accuracy")):
    value, around = 100 * steady_mean[measure][name], 100 * steady_reach[measure][name]
    print(f"{name:<14} {measure:<9} {value:3.0f} ± {around:.0f} %   printed: {printed[name]} %")
    assert abs(value - printed[name]) < around < 8
print(f"Ridge's accuracy: {steady_mean.accuracy['Ridge']:.0%}")
assert 0.43 < steady_mean.accuracy["Ridge"] < 0.52

# %% tags=["figure"]
measures = {"Ridge": "r2", "GaussianNB": "accuracy", "XGBClassifier": "accuracy"}
rows = {name: f"{name}: {measure.replace('r2', 'R²')}" for name, measure in measures.items()}
ours = {rows[name]: 100 * steady.loc[steady.model == name, measure] for name, measure in measures.items()}
theirs = {rows[name]: [printed[name]] for name in measures}
plot.runs({"ours, 8 tables": ours, "printed in REPARE": theirs}, "score [%]", x_range=(0, 100))

# %% [markdown]
# So the three are possible together *if Ridge's is an $R^2$*: each printed figure lies where a single run may fall.
# It remains a guess, since other settings can do the same. As an accuracy we found 9 % nowhere: Ridge gets 56 % of
# the classes right in the first setting and nearly half of them in this one. **Before models are compared, they need
# the same measure.**
#
# ## Where does a model go wrong?
#
# Accuracy counts a class that is one too low and one that is four too high the same. The confusion matrix doesn't:

# %%
data = tables["paper"]
true = data.classes[data.test]
predicted = prediction.MODELS["XGBClassifier"](data)
matrix = confusion_matrix(true, predicted, labels=range(1, 7))
classes = [str(k) for k in range(1, 7)]
plot.matrix(matrix, classes, classes, "true class", "predicted class", "share of the true class", shares=True,
            title="XGBClassifier, 1466 samples")  # fmt: skip

# %%
too_low, too_high = np.tril(matrix, -1).sum(), np.triu(matrix, 1).sum()
hit = matrix.diagonal() / matrix.sum(axis=1)
print("hit, by class:", *(f"{share:.0%}" for share in hit))
print(f"too low: {too_low / 1466:.0%}, too high: {too_high / 1466:.0%}, by more than one class: "
      f"{(abs(true - predicted) > 1).mean():.0%}")  # fmt: skip
assert 0.10 < too_low / 1466 < 0.20
assert (abs(true - predicted) > 1).mean() < 0.06
assert hit[2:].max() < hit[:2].min()

# %% [markdown]
# Below the diagonal the model is too low: the planner then keeps too small a distance. That is one flight in seven.
# The high classes, the dangerous ones, are rare, and none of them is hit as often as classes 1 and 2.
#
# ## Which features matter?
#
# Shuffle one column of the test, so that it says nothing any more, and see how many classes are lost
# (*permutation importance*). On real weather, with the model of `OffsetPredictor` (more of it below):

# %%
data = tables["greensboro"]
learn, exam = data.features[data.train], data.features[data.test]
exam = exam.clip(learn.min(), learn.max(), axis=1)  # a few hours lie just outside of what it learned from
predictor = OffsetPredictor().fit(learn, data.offsets[data.train])
true = data.classes[data.test]
accuracy = (predictor.predict_class(exam) == true).mean()
rng = np.random.default_rng(3)
lost = {name: [] for name in FEATURES}
for name in FEATURES * 10:
    shuffled = exam.assign(**{name: rng.permutation(exam[name])})
    lost[name].append(100 * (accuracy - (predictor.predict_class(shuffled) == true).mean()))
importance = dict(sorted(((name, float(np.mean(drops))) for name, drops in lost.items()), key=lambda item: -item[1]))
print("from most to least:", ", ".join(importance))
assert list(importance)[:2] == ["wind_speed", "wind_from_deg"]
assert importance["wind_speed"] > 25 > importance["wind_from_deg"] > 5 > importance["humidity_percent"]

# %% tags=["figure"]
sure = {name: 2.262 * np.std(drops, ddof=1) / np.sqrt(10) for name, drops in lost.items()}  # Student's t for 10 values
losses = {name.replace("_", " "): (m, m - sure[name], m + sure[name]) for name, m in importance.items()}
plot.intervals({"XGBoost, Greensboro": losses}, "accuracy lost when shuffled [percentage points]", digits=1)

# %% [markdown]
# Wind speed, then direction, then radiation; humidity and pressure hardly change the air's density. (A loss below 0 is
# luck: 1 466 rows.) A ranking like this finds what the generator was made of. On a real UAV it would have to be
# measured anew.
#
# ## How good can a model be?
#
# Not every wrong class is the model's fault. A flight draws its offset from Eq. 4, and even someone who knows all the
# physics doesn't know $\varepsilon$. They know the probability of each class,
#
# $$ P(k \mid \text{weather}) = \Phi\!\left(\frac{\ln k - \ln\tilde\xi}{s}\right)
#    - \Phi\!\left(\frac{\ln (k-1) - \ln\tilde\xi}{s}\right), \tag{6} $$
#
# (open at both ends for the first and the last class), and can do no better than to name the most probable one. The
# mean of its probability is the **Bayes limit**,
#
# $$ A^* = \frac1N \sum_i \max_k P(k \mid \text{weather}_i). \tag{7} $$

# %% tags=["nbval-check-output"]
data = tables["paper"]
limit = prediction.bayes_accuracy(data.log_median, data.noise)
best = 1 + prediction.class_probabilities(data.log_median, data.noise).argmax(axis=1)
drawn = [
    (
        prediction.offset_class(np.exp(data.log_median + data.noise * np.random.default_rng(seed).normal(size=7330)))
        == best
    ).mean()
    for seed in range(100)
]
print(f"Bayes limit {limit:.1%}, counted in 100 draws of all offsets {np.mean(drawn):.1%}")
assert abs(np.mean(drawn) - limit) < 4 * np.std(drawn) / 10

# %% [markdown]
# So XGBClassifier's 72 % are not 72 of 100, but 72 of 77 that can be had. What do better models do with the rest?
# They are told more of what we know:
#
# - **ordinal**: classes have an order. One classifier for each boundary, $P(\text{class} > k)$.
# - **log-offset**: the flights recorded an offset, and rounding it up first throws away most of it. Regression on
#   $\ln \xi$, and Eq. 6 with the scatter of its residuals for the class.
#
# The gap to the limit, computed with the probabilities of Eq. 6 so that luck plays no part:

# %%
real = compare_models(range(8), setting="greensboro", jobs=2, progress=False)
names = ["Ridge", "GaussianNB", "XGBClassifier", "ordinal", "log-offset"]
for name in names:
    print(f"{name:<14} below the limit by {100 * paper.bayes_gap[name]:4.0f} points (paper), "
          f"{100 * real.bayes_gap[name]:4.0f} (greensboro)")  # fmt: skip
for table in (paper, real):
    assert table.bayes_gap["log-offset"] < 0.015
    assert 0.03 < table.bayes_gap["XGBClassifier"] < 0.05
    assert table.bayes_gap["ordinal"] < 0.55 * table.bayes_gap["XGBClassifier"]
    assert table.bayes_gap["log-offset"] < 0.5 * table.bayes_gap["ordinal"]
    assert list(table.bayes_gap[names]) == sorted(table.bayes_gap[names], reverse=True)

# %% tags=["figure"]
gap = each.groupby("model", sort=False).bayes_gap
half, middle = T_8 * gap.sem(), gap.mean()
ours = {name: 100 * np.array([middle[name], middle[name] - half[name], middle[name] + half[name]]) for name in names}
real_half = real.bayes_gap_high - real.bayes_gap
theirs = {name: 100 * (real.bayes_gap[name] + np.array([0, -1, 1]) * real_half[name]) for name in names}
plot.intervals({"paper's setting": ours, "Greensboro": theirs}, "accuracy below the Bayes limit [points]", digits=1)

# %% [markdown]
# The regression of the logarithm comes within one point and a half of the limit, in both settings; XGBClassifier lacks
# about four. The order of the classes brings half of that back, the offset in place of its class more than half of
# the rest.
#
# ## Why safety wants another class
#
# The most accurate class is not the one to fly with. Of the best model's errors, more than half are too low, and
# "too low" means a wall. REPARE rounds up, but up from what? The sensible reading is a quantile: the class that the
# offset doesn't exceed with 95 %,
#
# $$ k_{95} = \lceil e^{\hat\mu + q_{95}} \rceil, \tag{8} $$
#
# with the predicted mean $\hat\mu$ of $\ln\xi$ and the 95 % quantile $q_{95}$ of the residuals, measured on rows that
# the model hadn't learned from. Its price is distance that mostly isn't needed.

# %%
low, excess = 100 * paper.under_prediction, paper.excess
for name in ("XGBClassifier", "log-offset", "95 % quantile"):
    print(f"{name:<14} too low {low[name]:3.0f} %, too high by {excess[name]:.1f} classes on average")
assert low["XGBClassifier"] > 12
assert 12 < low["log-offset"] < 16
assert low["log-offset"] / 100 > 0.5 * (1 - paper.accuracy["log-offset"])  # more than half of its errors
assert low["95 % quantile"] < 1.5
assert low["95 % quantile regression"] < 2.5
assert 0.4 < excess["95 % quantile"] < 0.8

# %%
data, quantiles = tables["paper"], np.array([0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.975, 0.99])
curve = np.array([[(k < data.classes).mean(), np.maximum(k - data.classes, 0).mean()] for k in (
    prediction.offset_class(np.exp(data.log_median + data.noise * z))
    for z in (0.0, 0.2533, 0.5244, 0.8416, 1.2816, 1.6449, 1.9600, 2.3263)
)])  # fmt: skip
known = "physics known, quantiles 50 to 99 %"
notes = {f"{quantiles[q]:.1%}".replace(".0%", "%"): (100 * curve[q, 0], curve[q, 1]) for q in (0, 2, 4, 5, 7)}
models = {name: [(low[name], excess[name])] for name in low.index}
plot.lines(100 * curve[:, 0], {known: curve[:, 1]}, "class too low: unsafe flights [%]",
           "excess: classes too high, mean", points=models, places={"1.5 %\ntoo low": 1.5}, notes=notes,
           x_range=(0, 32), y_range=(0, 0.9), colors={known: "0.5"})  # fmt: skip

# %% [markdown]
# Left of the dashed line at most 1.5 % of the flights are pushed further than predicted. The quantile of the residuals
# is there, for half a class more distance. It is less than 5 % because the quantile is rounded up once more, to whole
# metres. XGBoost's own quantile regression is a little less careful: it asks for the quantile of rows that it has
# learned by heart, and they scatter less.
#
# No model gets left of or below the grey curve by skill; the choice on it is a matter of policy, and only the
# quantile lets one make it. (GaussianNB and Ridge are far from it: worse on both counts.)
#
# ## Tomorrow's weather
#
# `OffsetPredictor` is the model to take along: the log-offset regression with its residuals. We let it learn from all
# hours of the record but the days around 19 March, write it to a file and read it again (XGBoost's own JSON):

# %% tags=["nbval-check-output"]
tomorrow = hours.iloc[77 * 24 : 78 * 24]
known = hours.drop(hours.index[75 * 24 : 80 * 24])
offsets = prediction.simulate_offsets(known, LIGHT_QUADROTOR, 3)
with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "offsets.json"
    OffsetPredictor().fit(known, offsets).save(file)
    predictor = OffsetPredictor.load(file)
upper = predictor.predict_offset(tomorrow)
print("hour  wind [m/s]  from [°]")
for hour in (0, 6, 12, 14, 18):
    print(f"{hour + 1:4d}  {tomorrow.wind_speed.iloc[hour]:10.1f}  {tomorrow.wind_from_deg.iloc[hour]:8.0f}")

# %% tags=["figure"]
truth = prediction.median_offsets(tomorrow, LIGHT_QUADROTOR)
clock = np.arange(1, 25)
inner = {"95 % of the simulated flights": (truth * np.exp(-1.96 * 0.21), truth * np.exp(1.96 * 0.21))}
said = {
    "their median": truth,
    "most probable class": predictor.predict_class(tomorrow),
    "rounded up: 95 % quantile class": upper,
}
plot.lines(clock, said, "hour of the day", "offset ξ [m]", bands=inner, steps=True,
           colors={"their median": plot.BLACK, "95 % of the simulated flights": "0.7"})  # fmt: skip

# %%
sigma = predictor.predict_sigma(tomorrow)
safe_distance = minimum_safe_distance(3 * sigma, LIGHT_QUADROTOR.diameter)
print(f"σ from {sigma.min():.2f} to {sigma.max():.2f} m; keep {safe_distance.min():.1f} to {safe_distance.max():.1f} m")
drawn = [prediction.simulate_offsets(tomorrow, LIGHT_QUADROTOR, seed) for seed in range(200)]
exceeded = np.mean([(offset > upper)[upper < 6].mean() for offset in drawn])
print(f"of 200 flights in each hour below the last class {exceeded:.1%} were pushed further")
assert exceeded < 0.05
assert np.allclose(safe_distance, upper + 0.5)

# %% [markdown]
# At three in the afternoon a strong wind blows along the streets, and the offset leaves the scale: the last class is
# only a least value. Where the prediction is the last class, the answer is not to fly (or to learn with more classes:
# `OffsetPredictor(class_count=20)`).
#
# In REPARE's terms the rounded-up offset is $3\sigma$, so $\sigma = \xi/3$ (Eq. 6), and
# $D_\text{min} = \xi + D_\text{uav}/2$ (REPARE Eq. 7) goes to the planner. Why $3\sigma$ isn't 99.7 % in a plane is the
# matter of [02 the Pauta criterion](02_pauta.ipynb).
#
# The predictor knows what it doesn't know: trees don't extrapolate, and a storm that it never saw looks to it like the
# strongest wind that it did. It warns, and it refuses a table with gaps or without a feature:

# %%
storm = tomorrow.iloc[12:13].assign(wind_speed=25.0)
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    predictor.predict_offset(storm)
print("warning:", caught[0].message)
for wrong in (tomorrow.drop(columns="radiation"), tomorrow.assign(wind_speed=tomorrow.wind_speed.where(clock > 2))):
    try:
        predictor.predict_offset(wrong)
    except ValueError as error:
        print("refused:", error)
assert "wind_speed = 25 is outside of 0 to" in str(caught[0].message)

# %% [markdown]
# ## What the paper says, what we find

# %% tags=["nbval-check-output"]
within = {
    "GaussianNB within 2 points of 59.426 %": abs(100 * paper.accuracy["GaussianNB"] - 59.426) < 2,
    "XGBClassifier within 2 points of 72.852 %": abs(100 * paper.accuracy["XGBClassifier"] - 72.852) < 2,
    "Ridge's R² within 2 points of 9.424 % (steady wind)": abs(100 * steady_mean.r2["Ridge"] - 9.424) < 2,
    "order XGBClassifier > GaussianNB in all runs": bool(
        (each[each.model == "XGBClassifier"].accuracy.values > each[each.model == "GaussianNB"].accuracy.values).all()
    ),
    "best model within 1.5 points of the Bayes limit": paper.bayes_gap["log-offset"] < 0.015,
    "95 % quantile class too low at most 1.5 %": paper.under_prediction["95 % quantile"] < 0.015,
}
for claim, holds in within.items():
    print(f"{claim:<52} {'yes' if holds else 'no'}")
assert all(within.values())

# %% [markdown]
# | REPARE, section 2.2.3 | says | we find, on simulated offsets |
# |---|---|---|
# | GaussianNB | 59.426 % | about 59 %: the setting was chosen so |
# | XGBClassifier | 72.852 %, the best of three | about 72 %, better than GaussianNB in all runs |
# | Ridge | 9.424 % "accuracy" | as an accuracy about 56 %; as an $R^2$ 9 % is possible beside the other two |
# | all three | shares of 1 466 test samples | none is $k/1466$ |
# | best model | XGBClassifier | four points below what is possible; the log-offset regression lacks one |
# | $\sigma$ | "by rounding up" | the best model is too low in 14 % of the flights, its 95 % quantile in 1 % |
#
# ## Your turn
#
# Three exercises: how often is a model too low, which class is the most probable, and can a printed figure be a count?
# [exercises/03_predicting_the_disturbance_exercises.ipynb](exercises/03_predicting_the_disturbance_exercises.ipynb).
