# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # How thick is a fair three-sided coin?
#
# Ten cells from nothing to an answer with an error bar. `jupytext --to ipynb fair_coin.py` makes a
# notebook of this file; as a script it runs as it is.

# %%
# 1. Install. The wheel is what scripts/wheel builds.
# %pip install --find-links ../../target/wheels "coinmc[plot]"
import coinmc
from coinmc import plot

# %%
# 2. What is tossed: a robot drops a spinning coin of 1 cm radius onto wood. 0 to 5 turns a second
#    and every start angle are equally likely; e = 0.5 says how it bounces, μ = 0.3 how it slides.
robot = {
    "seed": 1,
    "coin": {"ratio": 1.0, "radius_m": 0.01},
    "surface": {"restitution": 0.5, "friction": 0.3},
    "launch": {"preset": "robot"},
    "engine": {"flat": {}},
    "stop": {"tosses": 20_000},
}
print(coinmc.check(robot))

# %%
# 3. One toss, watched: its last bounces, and how it spends its energy.
toss = coinmc.trace(robot, toss=7)
print(toss)
plot.path(toss, times=(0.7 * toss.duration_s, toss.duration_s))
plot.energy(toss)

# %%
# 4. Many tosses, as arrays: what showed, after how many impacts.
tosses = coinmc.toss(robot)
print(tosses, "and", tosses.impacts.mean(), "impacts a toss")
print(tosses.estimate()["side"])

# %%
# 5. That coin, as high as its radius, is far from fair. Without bounces it would not be: the side
#    would show as often as its arc is long, (2/π)·atan(x/2) with x = H/R.
arc = coinmc.analytic.arc(1.0)
print(f"without bounces {arc:.3f}, and fair at {coinmc.analytic.fair_ratio('arc'):.4f}")

# %%
# 6. So the thickness decides. A range makes a sweep; every point gets 20,000 tosses.
sweep = {"coin.ratio": {"from": 0.5, "to": 2.5, "steps": 21}}
result = coinmc.estimate(robot, overrides=sweep)
print(result)

# %%
# 7. The curve with its intervals, beside the rule without bounces and what others published.
plot.probability(result)

# %%
# 8. Where it crosses 1/3, with the interval of the crossing.
[fair] = result.fair()
print(f"fair at H/R = {fair.value:.3f}")
print(f"{fair.confidence:.0%} interval: {fair.lo:.3f} to {fair.hi:.3f}")

# %%
# 9. How sure is that of any other table? What P(side) of the fair coin depends on.
at_fair = {"coin.ratio": fair.value}
plot.sensitivity(coinmc.sensitivity(robot, overrides=at_fair))

# %%
# 10. The fair coin. All three faces, and the map from start angle and spin to what shows: chance,
#     where the map is finer than a hand or a robot can aim.
print(coinmc.estimate(robot, overrides=at_fair))
plot.basin(robot, "tilt_deg", "wy_rad_s", (0, 180, 0, 31.4), shape=(600, 600), overrides=at_fair)
