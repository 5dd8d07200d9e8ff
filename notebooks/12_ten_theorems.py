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
# # Ten theorems on one flock
#
# **Aims.** Put the field's classics side by side: one start, many laws. What does each theorem promise from there,
# which hypothesis does the work, and what happens where it fails?
#
# ## A scene
#
# At a conference ten speakers show the same film: a cloud of dots that becomes a flock. Each has a law of her own
# and a theorem. In the coffee break somebody asks: "If I give all of you the *same* ten drones, at the same places,
# with the same velocities, what does each of you promise me?" Silence; then ten different answers, half of them with
# an "if". **What do the classics promise about one and the same start, and which hypothesis decides?**
#
# ## Two ideas, and two agents
#
# For two agents that see each other all laws do nearly the same: velocities tend to each other. There are two
# reasons why. *Energy*: friction takes kinetic energy out of the relative motion, and what remains must be at rest
# relative to each other, if the agents stay in touch. *Averaging*: each new velocity is a mean of the old ones, so
# the larger falls and the smaller rises, if they keep hearing each other. The words after "if" are the theorem. For
# $n$ agents everything depends on how they are kept in touch.
#
# <details><summary>Both reasons as formulas</summary>
#
# Write both down for two agents with the velocities $p_1, p_2$ and the same weight $a_{12}$ of the friction. The
# *energy* speaks of the square of the difference:
#
# $$\frac{d}{dt}\,\tfrac12\|p_1-p_2\|^2 = -2a_{12}\|p_1-p_2\|^2 .$$
#
# It needs $a_{12} = a_{21}$ and forces with a potential, and then bears as many forces as you like: their work goes
# into the potential and comes back. *Averaging* speaks of the largest and the least component:
# $p_1 \leftarrow \tfrac12(p_1 + p_2)$ never leaves the interval between the two. It needs no symmetry at all (agent 1
# may look at agent 2 without being looked at), and then bears *no other force*: a single push can throw a velocity out
# of the interval. So each idea buys its freedom with a restriction, and the table of theorems below is a table of such
# bargains.
#
# </details>
#
# Ten agents near a patch of a lattice, all at one speed, with headings about one direction:

# %%
import numpy as np

import flockana as fl
from flockana import plots
from flockana.course import Prediction, figures, grade
from flockana.scenarios.one_start import compare, entries, one_start

q, p = one_start()
ax = plots.configuration(q, p, r=8.4, title="the start of them all")
ax.margins(0.2)
print(f"{len(q)} agents, position diameter {fl.diameter(q):.3g}, velocity diameter {fl.diameter(p):.3g}")

# %% [markdown]
# **Figure 12.1.** The start: ten agents, links of nearly equal length, headings about one direction.
#
# Ten laws will move it. They differ in three things: which force two agents exert, how they compare velocities, and
# whom an agent perceives.
#
# | law | force of a pair | velocities | whom an agent perceives |
# |---|---|---|---|
# | Algorithm 1 | $\phi_\alpha n_{ij}$, bounded | friction that fades at the range | all within $r$ |
# | Algorithm 2; few informed | the same | the same, and to the target | within $r$; all, or three, the target |
# | dead zone | none between $d_1$ and $d_2$ | constant friction | all within its range |
# | Cucker and Smale; Ha and Liu | none | a weight that falls with distance, slowly or fast | everybody |
# | Tanner, fixed; switching | infinite at contact, none at $d$ | constant friction | links of the start; within $r$ |
# | links kept | $\psi = x^2/(r-x)$, infinite at the range | constant friction | links of the start |
# | averaged headings | none | the mean of the headings | all within $r$ |
#
# ## What is promised
#
# Two kinds of promise. Some say what an **energy** does: it falls, so that velocities agree, *if* something keeps the
# flock together. Others say what **averaging** does: a mean of neighbours never leaves their span, so that the spread
# of velocities shrinks, *if* the nets connect the agents often enough, or the weights fall slowly enough with distance.
# The theorems differ in these conditions.

# %%
for entry in entries():
    print(f"{entry.name} ({entry.theorem}):\n    {entry.promise}\n")

# %% [markdown]
# A statement in full: `print(fl.theorem("jlm-headings").statement)`.
#
# ## What happened

# %%
outcomes = compare()

# %% tags=["predict"]
guess = ...
Prediction(
    "Under how many of the ten laws are the agents one group at the end?",
    guess,
    sum(outcome.groups == 1 for outcome in outcomes),
)

# %%
axes = plots.side_by_side(outcomes)

# %% [markdown]
# **Figure 12.2.** The same start (grey) under ten laws, and the end, with the verdict of the theorem above each.

# %%
for outcome in outcomes:
    happened = f"velocity diameter x {outcome.velocity_share:.1e}, {outcome.groups} group(s)"
    print(f"{outcome.entry.name:>20}  {outcome.verdict.status:12} {happened}")
few = ("Algorithm 1", "Algorithm 2", "Dead zone", "Averaged headings", "Links kept")
ax = plots.velocity_diameters([outcome for outcome in outcomes if outcome.entry.name in few])

# %% [markdown]
# **Figure 12.3.** The largest difference of two velocities over that at the start, under five of the ten laws. The
# dead-zone flock has not settled at 60.
#
# A **vacuous** verdict beside a flock that flocks is no contradiction: the theorem says nothing about this start. Which
# hypothesis failed stands in the verdict:

# %%
for outcome in outcomes:
    for hypothesis in outcome.verdict.hypotheses:
        if hypothesis.status != "met":
            print(f"{outcome.entry.name}: {hypothesis.name} is {hypothesis.status}\n    {hypothesis.detail}\n")

# %% [markdown]
# ## Who keeps them in touch?
#
# Sort the ten by the answer to one question, and they become four.
#
# | what keeps agents in touch | laws | price |
# |---|---|---|
# | a pull to a common target | Algorithm 2, few informed | somebody must know the target |
# | a tension without bound at the range | links kept, Tanner's fixed net | unbounded forces |
# | weights that reach everywhere | Cucker and Smale, Ha and Liu | every agent hears all |
# | nothing: it is assumed, or components suffice | Algorithm 1, dead zone, switching net, headings | the run decides |
#
# The first line was proved in lecture 03 and the third in lecture 11. The second has the shortest proof of this course.
#
# > **Theorem (links kept).** Let each pair that is linked at the start have a potential $\psi \ge 0$ with
# > $\psi(x) \to \infty$ for $x \to r$, and let $H = \sum\psi + \tfrac12\sum\|p_i\|^2$ be finite at the start and never
# > rise. Then the length of none of these links ever reaches $r$, so a net that is connected at the start stays
# > connected.
#
# *Proof.* Each term of the sum is at most $H(t) \le H(0)$, because the others are not negative. Let $x_0 < r$ be such
# that $\psi > H(0)$ on $(x_0, r)$. A link is shorter than $x_0$ at the start or has $\psi \le H(0)$ there, so it is not
# in this interval; its length is continuous in time, and to reach $r$ it would have to pass through. $\square$
#
# <details><summary>Two hypotheses with numbers</summary>
#
# **Two hypotheses with numbers.** Whether a theorem speaks of a start is often one inequality. Do two of them for the
# start of Figure 12.1.
#
# *Ha and Liu.* Their weight is $4/(1 + x^2/r^2)$ with $r = 8.4$, divided by $n$. With the sizes of lecture 11 the start
# has $y = 26.0$ in space and $z = 1.12$ in velocities. No distance exceeds $2y$, and with this plain bound (lecture 11
# proved the sharper $\sqrt2\,y$ for its own theorem) the published one asks for
#
# $$z < \int_y^\infty\frac{4\,dx}{1 + (2x/r)^2} = 2r\Bigl(\frac{\pi}{2} - \arctan\frac{2y}{r}\Bigr) = 2.69 .$$
#
# The hypothesis is met. With the same places and all velocities multiplied by 2.42 it would not be, and the theorem
# would fall silent, although nothing visible changes at that number.
#
# *Links kept.* The start has 19 links, the longest of them 8.236 long: very near the range. Its tension alone costs
# $8.236^2/(8.4 - 8.236) = 414$; all links and the kinetic energy, $10\cdot\tfrac12 = 5$, make $H(0) = 1356$. A single
# link that cost as much would have $x^2/(8.4 - x) = 1356$, that is $x = 8.349$. So no link will ever be longer than
# that, at any time. Had this pair been two tenths of a length farther apart at the start, it would have been no link,
# and nothing would hold it.
#
# </details>
#
# Note what it does *not* say. Nothing keeps agents apart: in Figure 12.2 the unbounded tensions draw the whole flock
# into one place. A theorem on cohesion may cost you the one on collisions.
#
# ## A hypothesis about the whole run: joint connectivity
#
# Jadbabaie, Lin and Morse let each agent take the mean heading of itself and its neighbours, $\theta_i(t + 1) =
# \frac{1}{1 + |N_i(t)|}\bigl(\theta_i(t) + \sum_{j \in N_i(t)} \theta_j(t)\bigr)$.
#
# > **Theorem** (Jadbabaie, Lin and Morse 2003). If there is an infinite sequence of contiguous, non-empty, bounded
# > intervals of time, starting at $t = 0$, across each of which the agents are linked together, that is the union of
# > the nets of the interval is connected, then all headings tend to a common one.
#
# *Proof, for windows of at most $k$ steps.* (The paper does without a common bound, by a theorem of Wolfowitz.)
#
# 1. A step multiplies the vector of headings by a matrix with non-negative entries whose rows add up to 1. Its
#    diagonal entries, and those of neighbours, are $1/(1+|N_i|) \ge 1/n$.
# 2. Follow one agent, say agent 1, and say that $i$ *has heard of* it if the heading of $i$ contains that of agent 1
#    at the start with a positive weight. Since diagonals are positive, nobody ever forgets.
# 3. As long as somebody has not heard of it, the next window links one who has to one who has not, because the union
#    of its nets is connected. So each window adds at least one, and after $n - 1$ windows all have heard of agent 1.
# 4. Every weight passed on in one step is at least $1/n$, and there were at most $k(n-1)$ steps. So all have heard
#    with a weight of at least $e = n^{-k(n-1)} > 0$.
# 5. Over these $n - 1$ windows every new heading is a mean of old ones, with a weight of at least $e$ on the same
#    number $\theta_1$. So the largest heading is now at most $(1-e)\max_i\theta_i + e\,\theta_1$, and the least is
#    at least $(1-e)\min_i\theta_i + e\,\theta_1$.
# 6. Subtract: the spread of the headings has shrunk to at most $1 - e$ times what it was. Windows follow each other
#    for ever, so it tends to 0. The largest heading never rises and the least never falls, so both tend to the same
#    limit. $\square$
#
# The factor $1 - e$ is hardly below 1, and real flocks agree much faster; the proof asks only whether, not how fast.
#
# No single net need be connected: it is enough that the links seen over a window of time connect all, window after
# window, for ever. Three agents, of which only two are linked at a time, first 1 and 2, then 2 and 3, show it.

# %%
figure, axes = plots.subplots(1, 3, size=(9.0, 2.8))
nets = {"odd steps": [(0, 1)], "even steps": [(1, 2)], "the union of two steps": [(0, 1), (1, 2)]}
for ax, (title, links) in zip(axes, nets.items(), strict=True):
    figures.net(3, links, title=title, ax=ax)

# %% [markdown]
# **Figure 12.4.** Two nets of three agents that take turns. Neither is connected; their union is.
#
# <details><summary>The hypothesis by hand</summary>
#
# By hand, from the headings $0$, $0.3$ and $1$ (radians):
#
# | step | linked | headings | spread |
# |---|---|---|---|
# | 0 | | $0,\ 0.3,\ 1$ | 1 |
# | 1 | 1 and 2 | $0.15,\ 0.15,\ 1$ | 0.85 |
# | 2 | 2 and 3 | $0.15,\ 0.575,\ 0.575$ | 0.425 |
# | 3 | 1 and 2 | $0.3625,\ 0.3625,\ 0.575$ | 0.2125 |
# | 4 | 2 and 3 | $0.3625,\ 0.46875,\ 0.46875$ | 0.10625 |
#
# From the second step on each step halves the spread. (Two agents agree; the third differs by $y$; the mean of the
# third with one of them is $\tfrac12y$ away from both.) The bound of the proof is $1 - e$ with $e = n^{-k(n-1)} =
# 3^{-4} =
# \tfrac1{81}$ for every four steps; in truth the factor is $\tfrac1{16}$. And where do they end? Two who take their
# mean do not change the sum, so at the mean of the start, $1.3/3 = 0.433$. In general a heading that is heard by many
# counts more, and the limit is not the mean.
#
# </details>

# %%
turns = [fl.laplacian(3, np.array([pair])).toarray() for pair in ((0, 1), (1, 2))]
heading = np.array([0.0, 0.3, 1.0])
for step in range(12):
    print(f"step {step:2}: {heading.round(3)}" if step % 3 == 0 else "", end="\n" * (step % 3 == 0))
    heading = heading - 0.5 * turns[step % 2] @ heading  # two linked agents take their mean, the third keeps its own
print(f"spread after 12 steps: {np.ptp(heading):.4f}")

# %% tags=["facts"]
assert abs(np.ptp(heading) - 0.425 / 2.0**10) < 1e-12
assert next(each for each in outcomes if each.entry.theorem == "links-kept").position_share < 1e-6
sizes = [np.linalg.norm(each - each.mean(axis=0)) for each in (q, p)]
room = 2.0 * 8.4 * (np.pi / 2.0 - np.arctan(2.0 * sizes[0] / 8.4))
assert f"{sizes[0]:.1f} {sizes[1]:.2f} {room:.2f} {room / sizes[1]:.2f}" == "26.0 1.12 2.69 2.42"
long = np.linalg.norm(np.diff(q[fl.links(q, 8.4)], axis=1)[:, 0], axis=1)
H0 = (long**2 / (8.4 - long)).sum() + 5.0
assert f"{len(long)} {long.max():.3f} {long.max() ** 2 / (8.4 - long.max()):.0f} {H0:.0f}" == "19 8.236 414 1356"
assert f"{0.5 * (np.sqrt(H0**2 + 4.0 * 8.4 * H0) - H0):.3f}" == "8.349"
assert np.linalg.norm(p, axis=1).max() < 1.0 + 1e-12
assert abs(heading.mean() - 1.3 / 3.0) < 1e-12
assert len(fl.joint_windows(3, [np.array([pair]) for pair in ((0, 1), (1, 2)) * 6])) == 6
assert not any(np.linalg.eigvalsh(net)[1] > 1e-9 for net in turns)  # no single net is connected

# %% [markdown]
# Over a run we can see windows; "for ever" needs an argument. In the next run two groups head for
# each other and merge:

# %%
meet = fl.scenario("headings-meet").run()
figure, axes = plots.subplots(1, 2, size=(9.0, 3.4))
plots.joint_windows(meet.window(0.0, 60.0), ax=axes[0])
plots.diameters(meet, ax=axes[1])
print(fl.verify("jlm-headings", meet))

# %% [markdown]
# **Figure 12.5.** Left: relative connectivity, below 1 until the two groups meet at 35, and the windows across which
# the agents are linked together. Right: the spread of velocities falls from then on.
#
# The argument: once headings nearly agree, all that distances can still change adds up to less than what each of them
# is away from $r$. So no link is ever made or lost again, and a net that stays connected averages its headings to one.
#
# Where the groups part, the same verdict shows that they never meet again:

# %%
print(fl.verify("jlm-headings", fl.scenario("headings-part").run()))

# %% [markdown]
# ## A hypothesis about time: delay
#
# > **Theorem** (Olfati-Saber and Murray 2004). On a fixed, undirected, connected net all solutions of $\dot x(t) =
# > -Lx(t-\tau)$ tend to the mean of their starts if and only if $0 \le \tau < \pi/(2\lambda_n)$.
#
# *Proof.*
#
# 1. *One number at a time.* $L$ is symmetric. Along an eigenvector of $\lambda_k$ the equation is
#    $\dot z(t) = -\lambda_k z(t-\tau)$. For $\lambda_1 = 0$ the number $z$, the mean, is constant. The others must tend
#    to 0.
# 2. A solution $e^{st}$ needs $s = -\lambda_ke^{-s\tau}$. For $\tau = 0$ the only root is $-\lambda_k < 0$.
# 3. *No root comes in from infinity.* Where $\operatorname{Re} s \ge 0$, $|s| = \lambda_ke^{-\tau\operatorname{Re} s}
#    \le \lambda_k$. So as $\tau$ grows, a root can get into the right half-plane only through the imaginary axis.
# 4. *When does it?* Put $s = i\omega$ with $\omega > 0$:
#
# $$\begin{aligned}
# \omega &= \lambda_k && \text{compare moduli of } i\omega = -\lambda_ke^{-i\omega\tau} \\
# e^{-i\lambda_k\tau} &= -i, \quad\text{so}\quad \lambda_k\tau = \tfrac{\pi}{2},\ \tfrac{\pi}{2} + 2\pi,\ \dots &&
#   \text{compare phases}
# \end{aligned}$$
#
# 5. *Which way?* Differentiate $s\,e^{s\tau} = -\lambda_k$ with respect to $\tau$: $s'(1 + s\tau) + s^2 = 0$, so
#    $s' = -s^2/(1+s\tau)$, and at $s = i\omega$ its real part is $\omega^2/(1+\omega^2\tau^2) > 0$. Roots cross to the
#    right, and never come back.
# 6. So $z$ tends to 0 exactly if $\lambda_k\tau < \tfrac{\pi}{2}$. The largest eigenvalue asks for most. $\square$
#
# For each $k$ the root farthest to the right is $s = W_0(-\lambda_k\tau)/\tau$ with Lambert's function,
# $W_0(z)\,e^{W_0(z)} = z$. Draw its real part, and there is a surprise:

# %%
from flockana.stability import consensus_root

shares = np.linspace(0.01, 1.8, 180)
decay = np.array([-consensus_root(1.0, share).real for share in shares])
figure, ax = plots.subplots(size=(6.5, 3.2))
ax.plot(shares, decay)
for place, name in ((1.0 / np.e, "1/e: fastest"), (np.pi / 2.0, "π/2: the margin")):
    ax.axvline(place, color="black", linewidth=0.8, linestyle=":")
    ax.annotate(name, (place, 2.4), (18, 4), textcoords="offset points", fontsize=8)
ax.axhline(0.0, color="black", linewidth=0.8)
_ = ax.set(xlabel="delay times the eigenvalue, $\\lambda_k\\tau$", ylabel="decay rate over that without delay")

# %% tags=["facts"]
assert abs(shares[decay.argmax()] - 1.0 / np.e) < 0.02
assert abs(-consensus_root(1.0, np.exp(-1.0)).real - np.e) < 1e-12
assert consensus_root(1.0, 1.55).real < 0.0 < consensus_root(1.0, 1.59).real

# %% [markdown]
# **Figure 12.6.** How fast one mode of consensus decays over its delay. A *small* delay makes it faster, up to $e =
# 2.718$ times at $\lambda_k\tau = 1/e$; beyond $\tfrac{\pi}{2}$ it grows.
#
# (At $\lambda_k\tau = 1/e$ two real roots meet, at $s = -1/\tau$: put it into $s\,e^{s\tau}$.) A late agent overreacts,
# and a little overreaction is what a sluggish mode needs. But one delay serves all modes: what is right for $\lambda_2$
# may be beyond the margin of $\lambda_n$. The mode of $\lambda_n$ decides whether all disturbances die out; how fast
# they do is set by the slowest, for small $\tau$ that of $\lambda_2$.
#
# A further link never lowers $\lambda_n$: it adds $(x_i - x_j)^2 \ge 0$ to the quadratic form $x^\top Lx$, whose
# maximum over unit vectors is $\lambda_n$. So a better connected net never bears *more* delay:

# %%
from flockana.stability import consensus_system, delay_margin

for name, pairs in {"path": [(0, 1), (1, 2), (2, 3)], "complete": [(i, j) for j in range(4) for i in range(j)]}.items():
    net = fl.laplacian(4, np.array(pairs)).toarray()
    margin, largest = delay_margin(consensus_system(net)), np.linalg.eigvalsh(net)[-1]
    print(f"{name:>9}: τ* = {margin.delay:.6f}, largest λ = {largest:.4g}")

# %% [markdown]
# Four agents on a path, each of which hears late. Move the delay, as a share of the margin:

# %%
from flockana.course.picture_slider import slider

path = fl.laplacian(4, np.array([(0, 1), (1, 2), (2, 3)])).toarray()
bears = delay_margin(consensus_system(path)).delay
step = bears / 200.0


def late(ax, share):
    wait = round(share * bears / step)
    x = [np.array([2.0, -1.0, 0.5, -1.5])] * (wait + 1)  # at rest until now
    for _ in range(4000):
        x.append(x[-1] - step * path @ x[-1 - wait])
    ax.plot(step * np.arange(len(x) - wait), x[wait:])
    ax.set(xlim=(0.0, 20.0 * bears), ylim=(-4.0, 4.0), xlabel="t (time)", ylabel="$x_i$")


shares = (0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0, 1.05, 1.1)
slider(late, shares, name="τ/τ*", title="consensus of four agents that hear late", start=3)

# %% [markdown]
# ## What surprised, and what the theorems do not say
#
# That delay may help is one surprise; it depends on an equation of first order, and lecture 06 found no such thing for
# the stiff pairs of Algorithm 2, which are of second order. The other surprise is about the theorems.
#
# The theorems do not differ in what flocking *is*; they differ in what keeps agents in touch: a pull, a potential
# without bound at the range, weights that fall slowly, an assumption on the whole run. A vacuous verdict beside a
# beautiful flock is the normal case, not the exception. And of the corrected dead-zone theorem above, that
# velocities match within components is measured and not proved (lecture 09): a statement in a list is only as good
# as its weakest clause.
#
# ## Questions that come up
#
# *Which of the ten laws is the best?* The question has no answer before one says what is known, what may be assumed,
# and what must not happen. Each theorem names its price in the table above.
#
# *How can a vacuous verdict stand beside a perfect flock?* The theorem's hypothesis is not met by this start. The flock
# is a fact, the theorem has no part in it.
#
# *Does "union of nets" mean that all links exist at once?* No. They exist at different times, and information waits in
# the agents in between, because everyone keeps a share of its own heading.
#
# ## Summary
#
# - Theorems on flocking either let an energy fall or average; both need a hypothesis that keeps the agents in touch.
# - Joint connectivity is a hypothesis on a whole run; delay bounds depend on the largest eigenvalue of the Laplacian.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, derivation) Two neighbours head 10° to the left and 10° to the right of due east. Under the mean of
# headings in $[0, 2\pi)$, which way do they head after one step, in degrees, exactly?

# %% tags=["answer"]
degrees = ...

# %% tags=["solution"]
degrees = (10.0 + 350.0) / 2.0

# %% tags=["check"]
grade(degrees, 180.0, hint="10° to the right of east is 350°; `fl.verify('jlm-cut')` has more of it")

# %% [markdown] tags=["exercise"]
# **2.** ★ (1 point, derivation) What delay does consensus bear (a) on a star of 6 agents, (b) on the complete net of 6?
# (The largest eigenvalue of both is the number of agents. A list, each number to four significant digits.)

# %% tags=["answer"]
delay = ...

# %% tags=["solution"]
delay = [np.pi / (2.0 * 6.0), np.pi / (2.0 * 6.0)]

# %% tags=["check"]
grade(delay, [0.26179939, 0.26179939], digits=4, hint="the margin is stated above for any net")

# %% [markdown] tags=["exercise"]
# **3.** ★ (1 point, experiment) Nets of four agents: link 0-1, then 1-2, then nothing, then 2-3, then 0-1, 1-2 and 2-3
# at once. Into how many contiguous, jointly connected windows do the five instants divide, at most? (A whole number.)

# %% tags=["answer"]
count = ...

# %% tags=["solution"]
nets = [[(0, 1)], [(1, 2)], [], [(2, 3)], [(0, 1), (1, 2), (2, 3)]]
count = len(fl.joint_windows(4, [np.array(net, dtype=int).reshape(-1, 2) for net in nets]))

# %% tags=["check"]
grade(count, 2, hint="a window ends as soon as its links connect all four")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, derivation) At 1.5 times the delay margin of two agents that are linked ($\lambda_2 = 2$): at
# what rate does their difference grow, per time unit? (Four significant digits.)

# %% tags=["answer"]
rate = ...

# %% tags=["solution"]
rate = consensus_root(2.0, 1.5 * np.pi / 4.0).real

# %% tags=["check"]
grade(rate, 0.247105912, digits=4, hint="the deciding root is Lambert's; a rate is its real part")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, design) Design: six agents on a ring with the weight $g$ on all links have $\lambda_n = 4g$ and
# $\lambda_2 = g$. Their messages take 0.5 time units. Which $g$ must not be reached? (Four significant digits.)

# %% tags=["answer"]
weight = ...

# %% tags=["solution"]
weight = np.pi / (2.0 * 4.0 * 0.5)

# %% tags=["check"]
grade(weight, 0.78539816, digits=4, hint="the delay margin, solved for the weight")

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) Take two of the ten theorems, one on energy and one on averaging. Which hypothesis keeps
# the agents of each in touch, who sees to it, the law or an assumption, and what does a start look like that breaks
# it? Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# For Algorithm 2 the pull of the target keeps the flock in a ball, so cohesion comes from the law, for every start.
# For averaging of headings the nets must connect the agents jointly, again and again, which is assumed about the
# whole run: two groups that head away from each other break it, and then their headings need not agree.
#
# **Rubric, a point each:** for each theorem the hypothesis and who sees to it; a start that breaks one of them.


# %% [markdown] tags=["exercise"]
# **7.** ★ (1 point, player) Move the slider of $\tau/\tau^*$. Which is the least value on it at which the swings
# clearly grow? (Exactly.)

# %% tags=["answer"]
grows = ...

# %% tags=["solution"]
grows = 1.05  # at 1 they neither grow nor die out

# %% tags=["check"]
grade(grows, 1.05, hint="at the margin itself the swings keep their size")

# %% [markdown] tags=["exercise"]
# **8.** ★★ (2 points, proof) Headings between $-\tfrac{\pi}{2}$ and $\tfrac{\pi}{2}$ are averaged as in the theorem.
# Prove that the largest heading never rises and the least never falls, whatever the nets are, and give a sequence of
# nets for which the headings do not tend to a common one.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Every new heading is a mean of old ones with non-negative weights that add up to 1, so it lies between the least
# and the largest old heading. Hence the new largest is at most the old largest, and likewise for the least. If no
# agent ever has a neighbour, $N_i(t) = \varnothing$, every heading stays as it is; two different starts never agree.
#
# **Rubric, a point each:** a mean with weights that add up to 1 stays in the span; a sequence of nets that is not
# jointly connected.

# %% [markdown] tags=["exercise"]
# **9.** ★★★ (3 points, project) Open project, about two weeks: add an entry to the comparison, a law from the
# literature or your own, from the same start. State what its theorem promises of this start, which hypothesis does
# the work, and what happened. Then find the smallest change of the start for which the verdict changes, for your law
# and for two of the ten.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# A good answer implements the law as in lecture 11, states its theorem with hypotheses, verifies it on the start,
# and explains the verdict claim by claim. It varies one number of the start (a distance, the spread of headings)
# systematically, and names for each law the hypothesis that fails first.
#
# **Rubric, a point each:** the law with a theorem stated in full and a verdict; the boundary found for three laws
# with a stated search; the failing hypotheses named.
