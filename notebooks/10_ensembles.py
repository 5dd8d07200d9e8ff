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
# Three questions, three kinds of answer. Keep them apart from the first day on:
#
# | question | method | what an answer looks like |
# |---|---|---|
# | How often, among starts like these? | independent runs | $k$ of $N$, an interval, and the distribution of starts |
# | Is there any start at which it fails? | search | a start, or "none found" with budget and region |
# | Does it hold for all starts? | proof | a theorem, with hypotheses |
#
# No answer of one row replaces one of another. A proof of "almost every" does not tell how long it takes; a share of
# 100 % does not tell that there is no exception; a counterexample does not tell how often one meets it.
#
# "Almost every solution converges" is a statement about all initial states. One run verifies nothing; $k$ successes
# in $N$ runs say that the probability of success lies, with 95 % confidence, in the interval of Clopper and Pearson
# (1934). Even $N$ of $N$ leaves room.

# %%
import flockana as fl
from flockana import plots
from flockana.course import Prediction, figures, grade
from flockana.ensemble import phases

# %% tags=["predict"]
guess = ...
Prediction(
    "Sixty runs of sixty succeed. Down to which probability of success is that still compatible with the runs?",
    guess,
    float(fl.clopper_pearson(60, 60)[0]),
)

# %%
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
figure, axes = plots.subplots(1, 2, size=(10, 3.2))
_ = figures.interval_tails(57, 60, tuple(map(float, fl.clopper_pearson(57, 60))), axes=axes)

# %% [markdown]
# **Figure 10.1.** How many of 60 runs succeed, for the two ends of the interval of 57 successes. Left: with the
# probability 0.861, the lower end, 57 or more (filled) come out in 2.5 % of all experiments. Right: with 0.990, the
# upper end, 57 or fewer do.
#
# <details><summary>By hand: 4 of 5</summary>
#
# The upper end has the tail "4 or fewer", which is everything but "all 5":
# $1 - p^5 = 0.025$, so $p = 0.975^{1/5} = 0.995$. The lower end has the tail "4 or 5":
# $5p^4(1-p) + p^5 = 0.025$. Try $p = 0.3$: $0.0284 + 0.0024 = 0.0308$, too much; $p = 0.28$: $0.0221 + 0.0017 =
# 0.0239$, too little; the end is 0.284. So 4 of 5 says "between 28 % and 99.5 %", which is nearly nothing, and it is
# honest.
#
# </details>
#
# If all succeed, $k = N$, the lower end solves $p^N = 0.025$.
#
# **And Wald's formula?** The share $\hat p = k/N$ plus and minus $1.96\sqrt{\hat p(1-\hat p)/N}$ is in every
# textbook. Put $k = N$ into it: the root is 0, and the interval is the single point 1, for one run as for a million. It
# rests on a normal approximation that fails exactly where engineers work, near 1. How badly, can be computed without
# any simulation: for a given $p$ add up the probabilities of all $k$ whose interval contains $p$.

# %%
import numpy as np
from scipy.stats import binom

N = 20
k = np.arange(N + 1)
half = 1.96 * np.sqrt(k / N * (1.0 - k / N) / N)
kinds = {
    "Clopper and Pearson": np.array([tuple(map(float, fl.clopper_pearson(each, N))) for each in k]),
    "Wald": np.column_stack([k / N - half, k / N + half]),
}
chances = np.linspace(0.005, 0.995, 397)
covered = {
    name: np.array([binom.pmf(k, N, p)[(ends[:, 0] <= p) & (p <= ends[:, 1])].sum() for p in chances])
    for name, ends in kinds.items()
}
figure, ax = plots.subplots(size=(7, 3.2))
for name, share in covered.items():
    ax.plot(chances, share, label=f"{name}, at least {share.min():.2f}")
ax.axhline(0.95, color="black", linewidth=0.8, linestyle=":")
ax.set(xlabel="true probability of success", ylabel="probability that the interval contains it", ylim=(0.0, 1.02))
_ = ax.legend(loc="lower center")

# %% [markdown]
# **Figure 10.2.** How often an interval of 20 runs contains the truth. That of Clopper and Pearson never does so in
# less than 95 % of all cases, as the theorem says (and mostly in more: it is cautious). Wald's falls to
# a tenth near 0 and 1.
#
# <details><summary>Several claims at once</summary>
#
# A table with five claims has five intervals. Each is wrong with a probability of at most
# 5 %; that *some* is wrong may then have up to 25 %. For the table as a whole to be right with 95 %, give each interval
# $5/5 = 1\,\%$: the probability of a union is at most the sum of the probabilities, whether the claims depend on each
# other or not. A student who looks at forty measures and reports the two that came out "significant" at 5 % has found
# what forty tests of nothing give on average.
#
# </details>
#
# <details><summary>How many runs do I need?</summary>
#
# Decide how wide the interval may be, and solve for $N$. In the middle, where successes
# and failures are both frequent, Wald's formula will do for planning; where all runs succeed, the end has a
# closed form:
#
# $$\begin{aligned}
# 1.96\sqrt{p(1-p)/N} &\le 0.98/\sqrt N && p(1-p) \le \tfrac14: \text{ half the width, in the middle} \\
# 1 - 0.025^{1/N} &= 1 - e^{-(\ln 40)/N} \le (\ln 40)/N = 3.69/N && 1 - e^{-x} \le x: \text{ the whole width, if all
#   succeed}
# \end{aligned}$$
#
# | wanted | $N$ in the middle | $N$ if all succeed |
# |---|---|---|
# | to within 0.1 | 97 | 37 |
# | to within 0.01 | 9 604 | 369 |
# | to within 0.001 | 960 400 | 3 689 |
#
# *In the middle a further digit costs a hundred times the runs, at the edge ten times.* So a table of shares about one
# half does not deserve three digits, whatever the computer prints, and a claim of "always" is cheaper to support than a
# claim of "in 50 %".
#
# </details>
#
# To support "at most one failure in a million starts" takes 3.7 million runs without a failure. For claims of that kind
# one has to search, or to prove.

# %% tags=["facts"]
needed = [
    [int(np.ceil((0.98 / width) ** 2 - 1e-9)), int(np.ceil(np.log(40.0) / width))] for width in (0.1, 0.01, 0.001)
]
assert needed == [[97, 37], [9604, 369], [960400, 3689]]
assert all(
    1.0 - float(fl.clopper_pearson(each[1], each[1])[0]) <= w
    for each, w in zip(needed, (0.1, 0.01, 0.001), strict=True)
)
assert f"{np.log(40.0):.2f}" == "3.69"
assert [f"{float(end):.3f}" for end in fl.clopper_pearson(57, 60)] == ["0.861", "0.990"]
assert abs(float(fl.clopper_pearson(60, 60)[0]) - 0.025 ** (1 / 60)) < 1e-9
assert [f"{float(end):.3f}" for end in fl.clopper_pearson(4, 5)] == ["0.284", "0.995"]
assert [round(5 * x**4 * (1 - x) + x**5, 4) for x in (0.3, 0.28)] == [0.0308, 0.0238]
assert covered["Clopper and Pearson"].min() >= 0.95
assert covered["Wald"].min() < 0.12
assert [round(x**10, 3) for x in (0.9, 0.7, 0.6, 0.75)] == [0.349, 0.028, 0.006, 0.056]

# %% [markdown]
# ## What a source reports, seed by seed
#
# Jond's section 5.1 reports for ten agents that distances stay above 1.5 m, that velocities align within 2 s, that the
# flock is compact, and that its speed is as desired. Sixty seeds, on all cores:

# %%
printed = fl.ensemble("zone-51-printed", range(60))
mended = fl.ensemble("zone-51", range(60))
figure, axes = plots.subplots(1, 2, size=(12, 3.4))
plots.share_bars(fl.shares(printed, level=0.99), ax=axes[0], title="as printed")
plots.share_bars(fl.shares(mended, level=0.99), ax=axes[1], title="as recommended")
words = {
    "distances": "above 1.5 m",
    "coordination": "aligned in 2 s",
    "radius": "compact",
    "speed": "as fast as desired",
}
for ax in axes:
    names = [label.get_text().removeprefix("source:") for label in ax.get_yticklabels()]
    ax.set_yticks(ax.get_yticks(), [words.get(name, f"within {name}") for name in names])

# %% [markdown]
# **Figure 10.3.** Share of sixty seeds in which a claim of the source holds (dots) or is refuted (squares), with
# intervals at 99 % each, so at 95 % for all five at once. As printed one of five holds; with the recommended gains
# nearly all.
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
ax = plots.phase_diagram(phases(runs).sel(n=12), "ratio", "density")
_ = ax.set(xlabel="pull of the target over pair force, $c_1^\\gamma/c_1^\\alpha$", ylabel="density of the start")

# %% [markdown]
# **Figure 10.4.** How twelve agents end, for four ratios and two densities; where the seeds disagree, a cell is
# divided in their shares. Three seeds a cell show where to look and prove nothing about a share: 3 of 3 says "more than
# 29 %" with the interval above.
#
# Campaigns of thousands of runs want a store: `fl.ensemble(..., store="runs.sqlite")` writes every result as it
# arrives. Kill it at any moment and call it again: only what is missing is computed. `executor=` takes any
# `concurrent.futures.Executor`, Dask's for a cluster among them; the numbers are the same to the bit.
#
# ## Do not wait for the counterexample
#
# Random starts rarely hit the bad one. How rarely, is a matter of geometry. Let the starts fill a cube of ten
# dimensions (five agents in the plane) with sides of length 1, and let the bad ones be a ball of radius 0.1 somewhere
# in it. Its volume is
#
# $$\frac{\pi^5}{5!}\,0.1^{10} = 2.55\cdot10^{-10},$$
#
# so one random start in four *billion* is bad. A search does not wait for it. Every claim has a *margin*, a number that
# is positive where the claim holds, and smaller the nearer it is to failing: a least distance minus what is allowed, a
# bound minus what was measured. A search that minimises the margin goes downhill to the bad start. The simplest one
# takes six lines: change the best start so far at random, keep the change if the margin fell, and then be bolder, else
# be more careful.

# %%
bad = np.random.default_rng(4).uniform(0.2, 0.8, 10)


def distance_to_failure(x):
    return np.linalg.norm(x - bad) - 0.1


def downhill(seed):
    generator = np.random.default_rng(seed)
    x, stride, margins = generator.uniform(0.0, 1.0, 10), 0.3, []
    margins.append(distance_to_failure(x))
    while margins[-1] > 0.0:
        other = x + stride * generator.standard_normal(10)
        better = distance_to_failure(other) < margins[-1]
        x, stride = (other, 1.5 * stride) if better else (x, stride / 1.5**0.25)
        margins.append(distance_to_failure(x))
    return margins


searches = [downhill(seed) for seed in range(6)]
generator = np.random.default_rng(0)
drawn = np.minimum.accumulate([distance_to_failure(x) for x in generator.uniform(0.0, 1.0, (1000, 10))])
figure, ax = plots.subplots(size=(6.5, 3.2))
for margins in searches:
    ax.plot(margins, color="0.45", linestyle="-", linewidth=0.9)
ax.plot(drawn, label="best of so many random starts")
ax.plot([], [], color="0.45", linestyle="-", label="six searches downhill")
ax.axhline(0.0, color="black", linewidth=0.8)
ax.set(xlabel="runs", ylabel="least margin so far", xlim=(0, 1000))
_ = ax.legend()
print("runs of the six searches:", [len(margins) for margins in searches])

# %% tags=["facts"]
assert abs(np.pi**5 / 120.0 * 0.1**10 / 2.55e-10 - 1.0) < 1e-3
assert max(len(margins) for margins in searches) < 500
assert drawn[-1] > 0.1

# %% [markdown]
# **Figure 10.5.** Ten dimensions, a bad set of radius 0.1. Each of six searches finds it within a few hundred runs; the
# best of a thousand random starts is still far away.
#
# The figure flatters the search, and one should know why: its margin has one valley. With many valleys a search ends in
# the nearest, so one restarts it; where the margin is flat ("collided: yes or no") there is no downhill, so a claim
# needs a margin that says *by how much*. The library's search, CMA-ES, is the same idea with a cloud of starts: it
# keeps the better half, moves the cloud there, and stretches it along directions that have paid.
#
# Theorem 1(iii) excludes a collision below $c^*$; is $c^*$ generous? Ask for a collision with twice the energy, and
# then below it:

# %%
broken = fl.falsify("collision-energy", "head-on", claim="twice", budget=100)
print(broken)
safe = fl.falsify("collision-energy", "head-on", claim="below", budget=60)
print(safe)
_ = plots.falsification(broken)

# %% [markdown]
# **Figure 10.6.** The margin of the claim in each run of the search, and the smallest so far. Below 0 the claim fails.
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
# **Figure 10.7.** The counterexample: five agents at rest in four places, one of which two share (×2). Every link
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
# ## How to report
#
# Three sentences that one can sign. They are longer than the usual ones, and every word in them is needed.
#
# - *Share.* "Of 60 runs from starts drawn uniformly from the box of the scenario, with seeds 0 to 59, 60 flocked within
#   100 time units; with 95 % confidence the probability is at least 0.94." Named: distribution, number, horizon, what
#   counts as a success, confidence.
# - *Search.* "A search of 100 runs (CMA-ES, seed 1), over starts within 0.5 of the scenario's, found no start at which
#   the margin is below 0; the least margin was …." Named: method, budget, region, the nearest miss.
# - *Proof.* "Theorem 1(iii) excludes collisions from every start with an energy below $c^*$; … of the 60 starts are of
#   this kind." Named: the hypothesis, and how many of *your* starts meet it.
#
# A reader can repeat each of the three, and can see what it
# does not cover. Compare "in extensive simulations the algorithm always converged": what was drawn, how often, for how
# long, and what was counted?
#
# What do students get wrong here? They choose the success criterion after looking at the runs. They stop when the first
# twenty runs look good, and report twenty. They vary parameters and starts together, and then cannot say over what the
# share was taken. Decide number, distribution, horizon and criterion *before* the first run, and write them down.
#
# ## What surprised, and what the numbers do not say
#
# That a six-line search beats a billion coins is the surprise; that an interval from a textbook may contain the truth
# in a tenth of all cases is another.
#
# An interval is about a *distribution of starts*. Change the box from which starts are drawn, and the share changes;
# 60 of 60 in a small box say nothing about a large one. A search is about *existence*. It finds in a hundred runs
# what random starts would show once in a million, and says nothing about how often it would happen to a user.
# Neither is a proof, and a proof says nothing about frequencies. A good report has all three columns, and leaves
# none of them empty in silence.
#
# ## Questions that come up
#
# *If the interval is cautious, may I take a smaller one?* There are smaller ones, with a coverage of 95 % on average
# over the true values instead of for each of them. Say which you use; for safety take the cautious one.
#
# *Which seeds shall I take?* 0 to 59 are as good as any, if they are chosen before the first run. Whoever tries seeds
# until a nice picture comes out has searched, not sampled, and must report it as a search.
#
# *My 60 runs took a week. May I count each sample of a run?* No. Samples of one run depend on each other; a run is one
# toss.
#
# *The search failed. Shall I report it?* Yes, with region and budget. Others need not repeat it, and they see how hard
# you have tried.
#
# ## Summary
#
# - A share of successes is an estimate with an interval; $N$ of $N$ does not give 1.
# - The interval of Clopper and Pearson covers the truth with 95 % at least, for every $N$ and $p$; that of the normal
#   approximation does not.
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
# **7.** ★ (1 point, player) Show `found.run().player()`, the counterexample of the search. At which time have the two
# agents that end in one place come within 0.1 of each other? Give it to within 0.5.

# %% tags=["answer"]
met_at = ...

# %% tags=["solution"]
ended = found.run()
ended.player()
met_at = next(t for t, q in zip(ended.t, ended.q, strict=True) if fl.min_distance(q) < 0.1)
print(met_at)

# %% tags=["check"]
grade(met_at, 2.39971, within=0.5, hint="fl.min_distance of the positions at each sample, or zoom in")

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
