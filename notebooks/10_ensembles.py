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
# ## A scene
#
# "We ran our drones two hundred times, and two hundred times they flocked." The insurer asks: what is the
# probability that they do not? "Zero", says the start-up. "Somewhere below 1.8 %", says the statistician, "if your
# starts are those of the show". "I found a start at which they do not", says the engineer who had *looked* for one.
# **Who is right, and what does each of them know?** All three used the same simulator. They asked different
# questions: how often, among random starts? is there any? This lecture teaches both, and the honest sentence that
# goes with each.
#
# ## Two coins
#
# Toss a coin ten times and see ten heads. Is it a coin that always shows heads? A coin with a probability of heads
# of 0.9 does that in $0.9^{10} = 35\,\%$ of all experiments, one with 0.7 still in $2.8\,\%$. So ten successes
# exclude 0.6, and do not exclude 0.75. The interval of this lecture says the same for any $k$ of $N$.
#
# "Almost every solution converges" is a statement about all initial states. One run verifies nothing; $k$ successes
# in $N$ runs say that the probability of success lies, with 95 % confidence, in the interval of Clopper and Pearson
# (1934). Even $N$ of $N$ leaves room: for $N = 60$ down to 0.94.

# %%
import flockana as fl
from flockana import plots
from flockana.course import figures, grade
from flockana.ensemble import phases

for N in (10, 60, 200):
    low, high = fl.clopper_pearson(N, N)
    print(f"{N} of {N}: between {low:.3f} and {high:.3f}")

# %% [markdown]
# ## Where the interval comes from
#
# Let a run succeed with the probability $p$, which we do not know, independently of the others, and let $k$ of $N$
# runs have succeeded. Which $p$ are compatible with that? Rule out those under which so many successes, or so few,
# would be a rare accident, of 2.5 % at most.
#
# > **Theorem** (Clopper and Pearson 1934). Let the lower end of the interval be the $p$ at which $k$ *or more*
# > successes have the probability 2.5 %, and the upper end the $p$ at which $k$ *or fewer* have it (0 and 1 if there is
# > none). Whatever the true $p$ is, the interval contains it with a probability of at least 95 %.
#
# *Proof.*
#
# 1. The probability of $k$ or more successes grows with $p$. (Draw a number between 0 and 1 for each run, and call it a
#    success if it is below $p$: a larger $p$ never turns a success into a failure.) So the ends are well defined.
# 2. The true $p$ lies below the lower end only if, at this $p$, the number of successes that came out has a tail "so
#    many or more" of less than 2.5 %.
# 3. The numbers $k$ with such a tail are those from some $k'$ on, the tails fall with $k$; and the probability that
#    the number is $k'$ or more is that tail, below 2.5 %. So step 2 happens with a probability of at most 2.5 %.
# 4. The same holds of the upper end. Together the interval misses the true $p$ with a probability of at most 5 %.
#    $\square$

# %%
figure, ax = plots.subplots(size=(7, 3.4))
_ = figures.interval_tails(57, 60, tuple(map(float, fl.clopper_pearson(57, 60))), ax=ax)

# %% [markdown]
# **Figure 10.1.** 57 successes in 60 runs (dotted line). At the lower end, 0.861, so many or more have the probability
# 2.5 % (hatched, right tail); at the upper end, 0.990, so few or fewer have it (dotted, left tail).
#
# If all succeed, $k = N$, the lower end solves $p^N = 0.025$.

# %% tags=["facts"]
assert [f"{float(end):.3f}" for end in fl.clopper_pearson(57, 60)] == ["0.861", "0.990"]
assert abs(float(fl.clopper_pearson(60, 60)[0]) - 0.025 ** (1 / 60)) < 1e-9

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
# **Figure 10.2.** Share of sixty seeds in which a claim of the source holds (dots) or is refuted (squares), with
# intervals. As printed one of five holds; with the recommended gains nearly all.
#
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
# **Figure 10.3.** How twelve agents end, for four ratios and two densities; where the seeds disagree, a cell is
# divided in their shares.
#
# Campaigns of thousands of runs want a store: `fl.ensemble(..., store="runs.sqlite")` writes every result as it
# arrives. Kill it at any moment and call it again: only what is missing is computed. `executor=` takes any
# `concurrent.futures.Executor`, `cluster=` a Dask scheduler's address; the numbers are the same to the bit.
#
# ## Do not wait for the counterexample
#
# Random starts rarely hit the bad one. Every claim has a *margin*, a number that is positive where the claim holds,
# and smaller the nearer it is to failing. A search that minimises the margin goes downhill to the bad start. Theorem
# 1(iii) excludes a collision below $c^*$; is $c^*$ generous? Ask for a collision with twice the energy, and then
# below it:

# %%
broken = fl.falsify("collision-energy", "head-on", claim="twice", budget=100)
print(broken)
safe = fl.falsify("collision-energy", "head-on", claim="below", budget=60)
print(safe)
_ = plots.falsification(broken)

# %% [markdown]
# **Figure 10.4.** The margin of the claim in each run of the search, and the least so far. Below 0 the claim fails.
#
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
# **Figure 10.5.** The counterexample: five agents at rest in four places, one of which two share (×2). Every link
# looks like a lattice's.
#
# A counterexample is a file that anyone can replay: `found.save("e3.json")`, then `fl.replay("e3.json")`, or in a shell
# `flockana falsify --replay e3.json`.

# %%
import tempfile
from pathlib import Path

path = Path(tempfile.mkdtemp()) / "e3.json"
found.save(path)
print(fl.replay(path))

# %% [markdown]
# ## What surprised, and what the numbers do not say
#
# An interval is about a *distribution of starts*. Change the box from which starts are drawn, and the share changes;
# 60 of 60 in a small box say nothing about a large one. A search is about *existence*. It finds in a hundred runs
# what random starts would show once in a million, and says nothing about how often it would happen to a user.
# Neither is a proof, and a proof says nothing about frequencies. A good report has all three columns, and leaves
# none of them empty in silence.
#
# ## Summary
#
# - A share of successes is an estimate with an interval; $N$ of $N$ does not give 1.
# - A search for the least margin finds counterexamples that random starts miss.
# - That a search finds nothing proves nothing.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★★ (2 points, derivation) All of $N$ runs succeed. Compute the lower end of the 95 % interval of Clopper and
# Pearson (a) for $N = 50$, (b) for $N = 100$. Give the list, each to four significant digits.

# %% tags=["answer"]
lower = ...

# %% tags=["solution"]
lower = [0.025 ** (1 / 50), 0.025 ** (1 / 100)]  # p^N = 0.025
print(fl.clopper_pearson(100, 100))

# %% tags=["check"]
grade(
    lower, [0.928878264, 0.963783], digits=4, hint="the runs are independent: what is the probability that all succeed?"
)

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
# **6.** ★★ (2 points, words) A search of $10^5$ runs for a counterexample found none, and a report says that the
# claim is verified. What may the report say instead, and what does the number $10^5$ not tell, compared with $10^5$
# random runs? Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# It may say that this search, with this budget, seed, region and scenario, found no counterexample. The runs of a
# search are not independent draws: each start is chosen after the ones before, so no interval for a probability
# follows from their number. For random runs an interval would follow, for that distribution of starts only. Neither
# is a proof.
#
# **Rubric, a point each:** nothing was found in a stated region with a stated budget, which verifies nothing;
# adaptive runs are no independent sample, so no interval follows.


# %% [markdown] tags=["exercise"]
# **7.** ★ (1 point, player) Show `found.run().player()`, the counterexample of the search. At how many places do the
# five agents stand at the end? (A whole number.)

# %% tags=["answer"]
places = ...

# %% tags=["solution"]
ended = found.run()
ended.player()
places = len({tuple(x) for x in ended.q[-1].round(2)})

# %% tags=["check"]
grade(places, 4, hint="two agents share a place: zoom in, or round the positions")

# %% [markdown] tags=["exercise"]
# **8.** ★★ (2 points, proof) A claim is tested by $N$ independent random starts and never fails. Prove that one may
# say with 95 % confidence that it fails with a probability of at most $3/N$ ("the rule of three"), for the one-sided
# interval. Say what "with 95 % confidence" means here.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# If the claim fails with the probability $p$, no failure in $N$ runs has the probability $(1-p)^N$. Since
# $1 - p \le e^{-p}$, this is at most $e^{-pN}$, which is below 0.05 as soon as $pN > \ln 20 = 2.9957$, in particular
# for $p > 3/N$. So for every $p > 3/N$ the statement "$p \le 3/N$" would have been made wrongly in less than 5 % of
# the repetitions of the whole experiment; that is what 95 % confidence means. It is not the probability that $p$
# lies below $3/N$: $p$ is a fixed number.
#
# **Rubric, a point each:** the inequality with $e^{-pN}$ and $\ln 20 < 3$; confidence speaks of repetitions of the
# experiment, not of $p$.

# %% [markdown] tags=["exercise"]
# **9.** ★★★ (3 points, project) Open project, about two weeks: choose a claim about a scenario of the library that
# you believe and no theorem proves. Estimate its probability by an ensemble with an interval, then search for a
# counterexample with `falsify`. Report what each method found at equal cost, draw the best counterexample or the
# closest miss, and say what you would need in order to prove the claim.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# A good answer states the claim with all parameters and the distribution of starts, gives $k$ of $N$ with the
# interval, states budget, region and seed of the search, compares the number of runs, shows the worst run found, and
# separates what was measured, what was searched, and what would have to be proved.
#
# **Rubric, a point each:** a claim and a distribution stated in full, with the interval; a search with its budget
# and the worst run shown; an honest comparison and the missing proof named.
