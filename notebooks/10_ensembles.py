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
# # Ensembles and falsification
#
# **Aims.** Turn "in our simulations it always worked" into a share with an interval, run campaigns that survive a
# crash, and search for the start that breaks a claim instead of waiting for it.
#
# "Almost every solution converges" is a statement about all initial states. One run verifies nothing; $k$ successes
# in $N$ runs say that the probability of success lies, with 95 % confidence, in the interval of Clopper and Pearson
# (1934). Even $N$ of $N$ leaves room: for $N = 60$ down to 0.94.

# %%
import flockana as fl
from flockana import plots
from flockana.course import grade
from flockana.ensemble import phases

for N in (10, 60, 200):
    low, high = fl.clopper_pearson(N, N)
    print(f"{N} of {N}: between {low:.3f} and {high:.3f}")

# %% [markdown]
# ## What a source reports, seed by seed
#
# Jond's section 5.1 reports for ten agents that distances stay above 1.5 m, that velocities align within 2 s, that the
# flock is compact, and that its speed is as desired. Sixty seeds, on all cores:

# %%
printed = fl.ensemble("zone-51-printed", range(60))
mended = fl.ensemble("zone-51", range(60))
figure, axes = plots.subplots(1, 2, size=(12, 3.4))
plots.share_bars(fl.shares(printed), ax=axes[0], title="as printed")
_ = plots.share_bars(fl.shares(mended), ax=axes[1], title="as recommended")

# %% [markdown]
# The result is an `xarray.Dataset`, so everything else is a question to it: how close did they come?

# %%
print(printed["run"].sizes, sorted(printed.data_vars)[:6], "...")
print(f"least distance in the runs as printed: median {float(printed['min_distance'].median()):.2f} m")
print(f"least distance as recommended:         median {float(mended['min_distance'].median()):.2f} m")

# %% [markdown]
# ## A grid of parameters
#
# Where does Algorithm 2 flock, where does it fragment, where does it collapse? The scenario `phase` has the options
# `ratio` ($c_1^\gamma/c_1^\alpha$), `density` of the start, and `n`:

# %%
grid = {"ratio": [1e-4, 1e-2, 0.1, 1.0], "density": [0.3, 3.0], "n": [12]}
runs = fl.ensemble("phase", range(3), parameters=grid, theorems=())
_ = plots.phase_diagram(phases(runs).sel(n=12), "ratio", "density")

# %% [markdown]
# Campaigns of thousands of runs want a store: `fl.ensemble(..., store="runs.sqlite")` writes every result as it
# arrives. Kill it at any moment and call it again: only what is missing is computed. `executor=` takes any
# `concurrent.futures.Executor`, `cluster=` a Dask scheduler's address; the numbers are the same to the bit.
#
# ## Do not wait for the counterexample
#
# Random starts rarely hit the bad one. A search that minimises the claim's *margin* does. Theorem 1(iii) excludes a
# collision below $c^*$; is $c^*$ generous? Ask for a collision with twice the energy, and then below it:

# %%
broken = fl.falsify("collision-energy", "head-on", claim="twice", budget=100)
print(broken)
safe = fl.falsify("collision-energy", "head-on", claim="below", budget=60)
print(safe)
_ = plots.falsification(broken)

# %% [markdown]
# That nothing was found below $c^*$ proves nothing. The proof `collisions` does. Now the printed "almost every solution
# converges to an α-lattice" (erratum E3), among five agents that may start up to 0.5 from where they are in the
# scenario. A run refutes a limit only by what is certain at all later times: it must end in the basin of a strict
# minimum of the potential, and that minimum must be strained.

# %%
found = fl.falsify("lattice-limit-printed", "five-agents", budget=100, region=0.5, vary="q", seed=1)
print(found)
print(found.verdict.claim("lattice").detail)
ax = plots.snapshot(found.run(), velocities=False)
_ = ax.set_title("four places for five agents")

# %% [markdown]
# A counterexample is a file that anyone can replay: `found.save("e3.json")`, then `fl.replay("e3.json")`, or in a shell
# `flockana falsify --replay e3.json`.

# %%
import tempfile
from pathlib import Path

path = Path(tempfile.mkdtemp()) / "e3.json"
found.save(path)
print(fl.replay(path))

# %% [markdown]
# ## Summary
#
# - A share of successes is an estimate with an interval; $N$ of $N$ does not give 1.
# - A search for the least margin finds counterexamples that random starts miss.
# - That a search finds nothing proves nothing.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★★ (2 points, derivation) If all of $N$ runs succeed, the lower end $p$ of the 95 % interval of Clopper and
# Pearson is the probability of success at which $N$ successes still happen with probability 2.5 %. Write that as an
# equation and solve it for $N = 100$. (Four significant digits.)

# %% tags=["answer"]
lower = ...

# %% tags=["solution"]
lower = 0.025 ** (1 / 100)  # p^N = 0.025
print(fl.clopper_pearson(100, 100))

# %% tags=["check"]
grade(lower, 0.963783, digits=4, hint="the runs are independent: what is the probability that all succeed?")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, design) How many successes without a failure does it take until the lower end exceeds 0.99? (A
# whole number.)

# %% tags=["answer"]
runs_needed = ...

# %% tags=["solution"]
runs_needed = next(N for N in range(1, 1000) if fl.clopper_pearson(N, N)[0] > 0.99)

# %% tags=["check"]
grade(runs_needed, 368, hint="a loop over N; the low end grows with N")

# %% [markdown] tags=["exercise"]
# **3.** ★ (1 point, reading) Search for a start of `zone-tree` that breaks the bearing-distance Theorem 1 as printed
# (`zone-1-printed`). After how many runs is one found? (A whole number.)

# %% tags=["answer"]
evaluations = ...

# %% tags=["solution"]
evaluations = fl.falsify("zone-1-printed", "zone-tree", budget=20).evaluations

# %% tags=["check"]
grade(evaluations, 1, hint=".evaluations; the very first run will do")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, derivation) A claim fails at one start in a hundred. With what probability do 60 random runs show
# no failure? (Four significant digits.)

# %% tags=["answer"]
unseen = ...

# %% tags=["solution"]
unseen = 0.99**60

# %% tags=["check"]
grade(unseen, 0.547157, digits=4, hint="runs are independent")

# %% [markdown] tags=["exercise"]
# **5.** ★★ (2 points, derivation) And how many random runs does it take to see a failure with a probability of at least
# 0.95? (A whole number.)

# %% tags=["answer"]
runs_for_one = ...

# %% tags=["solution"]
import math

runs_for_one = math.ceil(math.log(0.05) / math.log(0.99))

# %% tags=["check"]
grade(runs_for_one, 299, hint="ask for the probability of none")

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) A search of $10^5$ runs for a counterexample found none, and a report says that the claim
# is verified. What may the report say instead, and what does the number $10^5$ not tell, compared with $10^5$ random
# runs? In your own words, at least 30 of them. (The check counts words, and your lecturer reads the text.)

# %% tags=["answer"]
honest = ...

# %% tags=["solution"]
honest = """It may say that this search, with this budget, seed, region and scenario, found no counterexample. The
runs of a search are not independent draws: each start is chosen after the ones before, so no interval for a
probability follows from their number. For random runs an interval would follow, for that distribution of starts
only. Neither is a proof."""
# Rubric, a point each:
# nothing was found in a stated region with a stated budget, which verifies nothing; adaptive runs
# are no independent sample, so no interval follows.

# %% tags=["check"]
grade(honest, lambda text: len(text.split()) >= 30, form="text", hint="a text of at least 30 words")
