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
# # α-lattices: crossings, planarity, Harborth's count
#
# **Aims.** Know which patterns keep all neighbours at one distance; prove Theorem 5 claim by claim in the plane, and
# find the claim that is false in space; measure how far a real flock is from a lattice.
#
# ## A scene
#
# Thirty-seven robots are to guard a square. Each should have its neighbours exactly 7 metres away: nearer is a
# waste, farther leaves gaps. **Which patterns allow that, how many radio links will there be, and do links ever
# cross?** The last question matters to whoever routes messages: a net without crossings is a map, and much is known
# about maps. Bees answer the first question with hexagons; we shall see that the honeycomb's *corners* are one
# answer, and its *centres* a better one.
#
# ## Two robots, three, four
#
# Two robots 7 apart are fine. Three form a triangle of side 7. A fourth can stand on the other side of one edge: a
# rhombus, whose long diagonal is twice the height of the triangle, $2\cdot\tfrac{\sqrt3}2\cdot7 = 12.1$. Is that
# allowed? Only if the two robots at its ends do not see each other, that is if $r \le 12.1$, because *all* neighbours
# have to be at the distance 7. A square of side 7 has diagonals of 9.9, so it is allowed for $r \le 9.9$. The range
# decides.
#
# > **Definition** (Olfati-Saber 2006). An *α-lattice* of scale $d$ and ratio $\kappa = r/d > 1$ is a configuration
# > in which $\|q_j - q_i\| = d$ for all neighbours, that is for all pairs with $\|q_j - q_i\| < r$.
#
# So a regular pattern whose nearest neighbours are $d$ apart qualifies if its *second* neighbours are not nearer
# than $r$: the ratio of second to first neighbour distance is the largest $\kappa$ allowed.

# %%
import numpy as np

import flockana as fl
from flockana import lattice, plots
from flockana.course import Prediction, figures, grade

for name in ("triangular", "square", "honeycomb", "simple_cubic", "fcc", "hcp", "bcc"):
    print(f"{name:>12}: κ at most {lattice.max_ratio(name):.4f}")
d, r = 7.0, 8.4
q = lattice.hexagonal_patch(3, d)
pairs = lattice.links(q, r)
print(f"{len(q)} agents, {len(pairs)} links, α-lattice: {lattice.is_alpha_lattice(q, d, r)}")

# %% [markdown]
# At the usual $\kappa = 1.2$ all of these qualify but one: the body-centred cubic lattice has second neighbours at
# $2/\sqrt3 = 1.155$ times the first distance.
#
# The same 37 places, with the range moved: below $\kappa = 1$ there are no links, up to $\sqrt3$ those of the
# lattice, and beyond it the second neighbours come into range.

# %%
from flockana.course.picture_slider import slider


def with_range(ax, ratio):
    title = f"α-lattice: {lattice.is_alpha_lattice(q, d, ratio * d)}, {len(lattice.links(q, ratio * d))} links"
    plots.configuration(q, d=d, r=ratio * d, ax=ax, bar=False, title=title)


kappas = (0.95, 1.05, 1.2, 1.4, 1.6, 1.7, 1.75, 1.9, 2.05)
slider(with_range, kappas, name="κ", title="links of a patch of the hexagonal lattice", size=(4.6, 4.6), start=2)

# %% [markdown]
# ## Theorem 5
#
# > **Theorem 5** (Olfati-Saber 2006, as lecture slides on it print it). Let $q$ be an α-lattice of scale $d > 0$ and
# > ratio $\kappa > 1$ with distinct nodes. Then (i) its net is planar, $m = 2, 3$;
# > (ii) it has at most $3n - 6$ links, $m = 2$, $n \ge 3$; (iii) with
# > $n > m + 1$ nodes it is not complete, $m = 1, 2, 3$.
#
# A net is *planar* if it can be drawn in the plane without crossing links, *complete* if all pairs are linked. (The
# slides print (ii) without $n \ge 3$: erratum E6, exercise 4.)
#
# *Proof of (i) in the plane.* The positions of the agents are a drawing. We show that its links do not cross.
#
# 1. Suppose the links $\{1, 2\}$ and $\{3, 4\}$ of four distinct agents have a point in common. If agent 3 lies on
#    the link $\{1, 2\}$, then 1 and 3 are nearer than $d$, which step 4 excludes (likewise for the other three).
#    Otherwise 1, 3, 2, 4 are the corners of a convex quadrilateral, with the two links as its diagonals.
# 2. The four angles of a quadrilateral add up to 360°, so one of them is at least 90°. Let it be the one at agent 1,
#    between the sides to 3 and to 4. (For another corner exchange the names.)
# 3. In the triangle 3, 1, 4 the side opposite to 1 is the link $\{3, 4\}$. By the law of cosines $\|q_4-q_3\|^2 \ge
#    \|q_3-q_1\|^2 + \|q_4-q_1\|^2 \ge 2\min(\|q_3-q_1\|, \|q_4-q_1\|)^2$. So one of the two sides is at most
#    $\|q_4-q_3\|/\sqrt2 = d/\sqrt2$.
# 4. Its ends are nearer than $d < r$, so they are neighbours; but neighbours are exactly $d$ apart. Contradiction.
#    $\square$

# %%
figure, ax = plots.subplots(size=(4.4, 3.8))
_ = figures.crossing_links(ax=ax)

# %% [markdown]
# **Figure 4.1.** Two crossing links of length 1 (solid and dashed). Of the four distances between their ends, one at
# least is no more than $1/\sqrt2 = 0.71$; here it is 0.62.
#
# *Proof of (ii).* A planar drawing of a connected net of $n \ge 3$ agents with $e$ links divides the plane into $f$
# faces, the outer one included, with $n - e + f = 2$ (Euler). Why? Draw the net link by link, from a single agent on,
# always one that touches what is drawn. For the single agent $1 - 0 + 1 = 2$. A link to a new agent raises $n$ and $e$
# by 1. A link between two agents that are there already closes a circuit and cuts one face in two: it raises $e$ and
# $f$ by 1. Neither changes $n - e + f$.
#
# 1. Every face has at least 3 links on its boundary, counted twice if the face lies on both sides, because there are
#    no double links and $n \ge 3$.
# 2. Every link is counted twice in all, so $3f \le 2e$.
# 3. Insert $f = 2 - n + e$: $\;6 - 3n + 3e \le 2e$, that is $e \le 3n - 6$.
# 4. A net that is not connected becomes so by adding links that do not cross, which only raises $e$. $\square$
#
# *Proof of (iii).* Suppose $n \ge m + 2$ agents are pairwise linked, hence pairwise $d$ apart.
#
# 1. Let $z_i = q_i - q_n$, $i = 1, \dots, n-1$. Then $\|z_i\|^2 = d^2$, and from $\|z_i - z_j\|^2 = d^2$ follows
#    $\langle z_i, z_j\rangle = \tfrac12d^2$ for $i \ne j$.
# 2. So the matrix of scalar products is $\tfrac12d^2(I + \mathbf 1\mathbf 1^\top)$. Its eigenvalues are
#    $\tfrac12d^2$ and $\tfrac12d^2n$: it is invertible.
# 3. Vectors with an invertible matrix of scalar products are linearly independent. But there are $n - 1 \ge m + 1$ of
#    them in $\mathbb R^m$. Contradiction. $\square$
#
# **The sharp count.** $3n - 6$ is never reached by an α-lattice: the outer face is large. Harborth (1974) proved the
# sharp bound $\lfloor 3n - \sqrt{12n-3}\rfloor$, which hexagonal spirals reach.
#
# <details><summary>By hand, and where the root comes from</summary>
#
# *By hand.* Seven agents, one in the middle of six: six spokes and six links around make 12, and $3\cdot7 - \sqrt{81} =
# 12$. A hexagon with $k$ rings has $n = 3k^2 + 3k + 1$ agents, so $12n - 3 = (6k+3)^2$ is a square, and the bound is
# $3n - 6k - 3 = 9k^2 + 3k$: 12, 42, 90 for $k = 1, 2, 3$. Where does the root come from? It counts what is missing at
# the rim. An agent inside has six links; if all had, there would be $3n$ of them. The $6k$ agents of the rim lack two
# each, the six corners one more, together $12k + 6$ ends, that is $6k + 3$ links.
#
# </details>

# %%
print(f"3n − 6 = {lattice.planar_bound(37)}, Harborth {lattice.harborth(37)}, the patch has {len(pairs)} links")
sizes = np.arange(3, 61)
figure, ax = plots.subplots(size=(6, 3.2))
ax.plot(sizes, [lattice.planar_bound(n) for n in sizes.tolist()], "--", label="3n − 6")
ax.plot(
    sizes,
    [len(lattice.links(lattice.hexagonal_spiral(n, d), r)) for n in sizes.tolist()],
    "-",
    label="hexagonal spiral",
)
ax.plot(sizes[::3], [lattice.harborth(n) for n in sizes[::3].tolist()], "o", markersize=3, label="Harborth")
ax.set(xlabel="n, agents", ylabel="links")
_ = ax.legend()

# %% [markdown]
# **Figure 4.2.** The bound of Theorem 5(ii), Harborth's bound, and the links of hexagonal spirals, which lie on the
# latter for every $n$.
#
# ## What a flock really ends in
#
# Algorithm 2 ends near a lattice, not in one: the γ-agent's pull compresses it. Colour and shape of an agent show
# its number of neighbours; six of them is the perfect interior.

# %%
run = fl.scenario("paper-flocking").run()
end = run.q[-1] - run.q[-1].mean(axis=0)
net = lattice.links(end, r)
length = np.linalg.norm(end[net[:, 0]] - end[net[:, 1]], axis=1)

# %% tags=["predict"]
guess = ...
Prediction("Links are to be 7 long. How long is the longest of this flock at rest?", guess, float(length.max()))

# %%
plots.defect_map(end, net, lattice.coordination(len(end), net), strain=length / d - 1)
print(f"links {length.min():.2f} to {length.max():.2f} long, crossings {len(lattice.crossings(end, net))}")

# %% [markdown]
# **Figure 4.3.** The end of the flock of lecture 00. Most inner agents have six. Near the lower edge a few have
# five, beside one stretched link: a *defect*, as in a crystal.
#
# How far is it from a lattice? Two measures are in use. A configuration is a *quasi-lattice* with the uncertainty
# $\delta$ if all its links have lengths between $d - \delta$ and $d + \delta$: the worst link counts. The *deviation
# energy* is a mean,
#
# $$E(q) = \frac{1}{e+1}\sum_{\text{links}}\bigl(\|q_j - q_i\| - d\bigr)^2,$$
#
# with $e$ the number of terms, each link counted in both orders. If every term is at most $\delta^2$, the mean is, so
# $E \le \delta^2$ for a quasi-lattice. Take three links of the lengths 7, 7 and 8.1. The worst one gives $\delta =
# 1.1$. The mean has $e = 6$ terms, of which two are not 0: $E = 2\cdot1.1^2/7 = 0.346$, and $\sqrt E = 0.59$, about
# half of $\delta$. With thirty links instead of three $\sqrt E$ would be $0.2$. The converse fails: one bad link among
# hundreds hardly shows in $E$. Whoever reports $E$ alone hides the worst link, and whoever reports $\delta$ alone lets
# one link speak for all. Look at both.

# %%
worst = abs(length - d).max()
mean = np.sum((length - d) ** 2) * 2 / (2 * len(net) + 1)
print(f"worst link: off by {worst:.2f}, δ/d = {worst / d:.3f};  deviation energy: √E/d = {np.sqrt(mean) / d:.3f}")

# %% [markdown]
# The typical link is off by some hundredths of $d$ and the worst one by sixteen: it spans the defect. This flock is
# a good lattice with a flaw, which neither number alone would say.
#
# **Why triangles?** In lecture 01's potential a link at $d$ costs 0 and a pair out of range 0.74. So among lattices
# of $n$ agents the energy is $V = \psi_\alpha(r_\alpha)\bigl(\tfrac12n(n-1) - e\bigr)$ with $e$ links: the more
# links, the better. A square lattice has about $2n$ links, a honeycomb $\tfrac32n$, a triangular one nearly $3n$. A
# flock that descends $V$ has every reason to form triangles, and squares that arise by chance shear into rhombi,
# which costs nothing, until a fifth pair comes into range.
#
# Theorem 5 is about lattices, and this state is not one: its claims are vacuous here. Does the flock's net cross
# itself nevertheless? Go back to the proof: step 3 needs no lattice.
#
# > **Theorem (extension).** In the plane let $\ell$ be the length of the longest link. If all pairs of agents are
# > farther apart than $\ell/\sqrt2$, no two links cross. In particular this holds if all pairs are farther apart
# > than $r/\sqrt2$.
#
# *Proof.* Steps 1 to 3 with $\|q_4-q_3\| \le \ell$ give two agents within $\ell/\sqrt2$ of each other. (If 3 lies on
# the link $\{1, 2\}$, one of its ends is within $\ell/2$.) As links are shorter than $r$, so is $\ell$. $\square$
#
# Here the closest pair is a little nearer than $r/\sqrt2$, so the second form is vacuous; the first applies.

# %%
said = fl.verify("os-5", q=end, d=d, r=r)
for claim in said.claims:
    print(f"{claim.name:>18}: {claim.status}")
limits = [fl.min_distance(end), r / np.sqrt(2), length.max() / np.sqrt(2)]
print("closest pair {:.2f}, r/√2 = {:.2f}, longest link/√2 = {:.2f}".format(*limits))

# %% tags=["facts"]
assert [said.claim(name).status for name in ("i", "extension", "extension-lengths")] == [
    "vacuous",
    "vacuous",
    "verified",
]
assert 0.1 < worst / d < 0.2
assert np.sqrt(mean) / d < 0.05
assert abs(mean - 2 * np.sum((length - d) ** 2) / (2 * len(net) + 1)) < 1e-12
assert length.max() / np.sqrt(2) < fl.min_distance(end) < r / np.sqrt(2)
assert all(len(lattice.links(lattice.hexagonal_spiral(n, d), r)) == lattice.harborth(n) for n in range(3, 61))
assert lattice.max_ratio("bcc") < 1.2
assert [lattice.harborth(3 * k * k + 3 * k + 1) for k in (1, 2, 3)] == [12, 42, 90]
assert [len(lattice.links(lattice.hexagonal_patch(k, d), r)) for k in (1, 2, 3)] == [12, 42, 90]
missing = 6 - lattice.coordination(len(q), pairs)
assert sorted(missing.tolist())[-18:] == [2] * 12 + [3] * 6
assert f"{2 * 1.1**2 / 7:.3f} {np.sqrt(2 * 1.1**2 / 7):.2f} {np.sqrt(2 * 1.1**2 / 61):.1f}" == "0.346 0.59 0.2"
assert lattice.rigidity(lattice.square(2, 2, d), lattice.links(lattice.square(2, 2, d), r)).flexes == 1
assert lattice.rigidity(q, pairs).self_stresses == 19
assert lattice.coordination(len(end), net).max() == 6

# %% [markdown]
# (The library's headline for all claims together would read *verified*, because one claim is verified, none is
# refuted, and vacuous ones do not count. It is the claims that one has to read.)
#
# ## In space, planarity fails
#
# In space links do not cross either, by the same proof within a plane through four agents. But does that make the
# net planar? Planar means: *can be drawn in the plane*. In space, links that do not meet are the rule. Any net at
# all can be drawn in space without crossings: put the nodes on the curve $(t, t^2, t^3)$, of which no four points
# lie in one plane. So the argument proves nothing, and the claim is false. Eight agents of a face-centred cubic
# lattice suffice (erratum E5):

# %%
eight = np.array([[0, 0, 0], [1, 0, 1], [2, 1, 1], [1, 1, 0], [2, 2, 0], [2, 1, -1], [1, 0, -1], [2, 0, 0]])
fragment = eight * d / np.sqrt(2)
edges = lattice.links(fragment, r)
print(f"α-lattice: {lattice.is_alpha_lattice(fragment, d, r)}, crossings: {len(lattice.crossings(fragment, edges))}")
witness = lattice.kuratowski(8, edges)
print(f"planar: {lattice.is_planar(8, edges)}; {witness}")
figure, ax = plots.subplots(m=3, size=(5, 4.5))
plots.configuration(fragment, d=d, r=r, ax=ax, bar=False)
for link in witness.links:
    ax.plot(*fragment[link].T, color="black", linestyle="-", linewidth=2.5)
for corners, marker in ((witness.corners[:3], "s"), (witness.corners[3:], "^")):
    ax.plot(*fragment[list(corners)].T, marker, color="black", linestyle="none", markersize=9)

# %% [markdown]
# **Figure 4.4.** Eight agents in space, all neighbours exactly 7 apart, no links crossing, and a net that no drawing
# in the plane can avoid to cross. By Kuratowski's theorem such a net contains five nodes or three and three, joined
# by paths all to all: here squares to triangles, along the heavy links.
#
# ## Rigidity
#
# Does a lattice hold its shape? Let the agents have velocities $p_i$. A link keeps its length to first order if
# $\langle q_j - q_i, p_j - p_i\rangle = 0$: one linear equation for each link, in $nm$ unknowns. The matrix of these
# equations is the *rigidity matrix*. Translations and rotations always solve them, in the plane 3 dimensions. If there
# are no other solutions, the framework is *infinitesimally rigid*; that needs at least $2n - 3$ links. A triangle has
# $3 = 2\cdot3 - 3$ and is rigid. A square has 4, one short of $5$, and shears into a rhombus: let the lower two agents
# rest and the upper two move to the right with the velocity $(1, 0)$. The lower link has $\langle(7, 0), (0,
# 0)\rangle = 0$, the upper one too, as its ends move alike, and the two sides have $\langle(0, 7), (1, 0)\rangle = 0$.
# All four equations hold, and the motion is neither a translation nor a rotation.

# %%
for name, places in (("square", lattice.square(2, 2, d)), ("patch of 37", q)):
    found = lattice.rigidity(places, lattice.links(places, r))
    print(f"{name}: {found}")

# %% [markdown]
# Links beyond $2n - 3$ are redundant and carry *self-stress*: some may pull while others push, and the whole is at
# rest. The patch of 37 has $90 - 71 = 19$ such states, which is why a flock can come to rest strained.
#
# ## How many links does a flock need?
#
# A flock in the plane has three interesting numbers of links. With $n - 1$ it can just be connected: a tree, in
# which every lost link cuts the flock in two. With $2n - 3$ it can just be rigid: the shape holds, and no link can
# be spared. With Harborth's $\lfloor3n - \sqrt{12n-3}\rfloor$ it is as full as a lattice can be. For the 37 robots
# of the scene these are 36, 71 and 90. The surplus of 19 is redundancy: so many links may fail, if they are the
# right ones, before the shape goes soft.
#
# Now the practical side. Each link is a radio channel that has to be kept alive, so a designer would like few; each
# missing link makes the shape softer and the agreement slower ($\lambda_2$ of lecture 00a), so the same designer
# would like many. An α-lattice does not ask: its links are all the pairs in range. Whoever wants fewer must choose
# them, and then the law is no longer one of *all neighbours*, but of a graph that somebody has planned (formation
# control; the directed trees of lecture 08 are an example). What this lecture says about crossings matters there
# too: a planar net can be drawn on a map for the operator, and messages can be routed along its faces.
#
# ## Questions that come up
#
# *Is there an α-lattice for every $n$?* Yes. Leave agents out of a lattice: the condition is one on pairs, so what is
# left is a lattice again. It may have fewer links, and may even be disconnected. In the extreme, agents that are all
# out of each other's range form an α-lattice without links: the definition does not ask for a connected net.
#
# *Theorem 5 says "with distinct nodes". Can nodes of a lattice coincide?* No: two agents in one place are nearer than
# $r$, so they are neighbours, and their distance is 0 instead of $d$. The words are a reminder and no further
# hypothesis.
#
# *Does (iii) say that a flock of five in the plane cannot all see each other?* Only if it is a lattice. Five agents
# that are squeezed into one place all see each other, and lecture 03 has shown what squeezes them.
#
# *A bound with a floor, a bound with a root: which one should I remember?* $3n$. Each agent inside has six neighbours,
# and each link is shared by two. Everything else is about the rim.
#
# ## What surprised, and what the theorem does not say
#
# The definition leaves the pattern open, and yet every flock that we ran shows triangles: not because squares are no
# lattices, but because triangles have more links, hence less energy. Theorem 5 does not say that α-lattices exist
# for every $n$ and every net, nor that a flock ends in one (lecture 07). And a proof that is right for the plane was
# printed for space too: the picture of links that do not cross is so convincing that one forgets what planar means.
#
# ## Summary
#
# - Which patterns are α-lattices is decided by the second neighbours.
# - Two crossing links have two ends within $1/\sqrt2$ of the longer link; so links of lattices do not cross, and
#   links of any net do not if all pairs are far enough apart.
# - Euler's formula bounds the links by $3n - 6$; Harborth's bound is sharp.
# - In space a lattice's net need not be planar.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★★ (2 points, derivation) An α-lattice in the plane has 100 agents. (a) How many links does Theorem 5 allow?
# (b) And Harborth's bound? (c) How many links does infinitesimal rigidity need at least? Give the list of three
# whole numbers.

# %% tags=["answer"]
counts = ...

# %% tags=["solution"]
counts = [3 * 100 - 6, lattice.harborth(100), 2 * 100 - 3]

# %% tags=["check"]
grade(counts, [294, 265, 197], hint="the three formulas are in the lecture; Harborth's is rounded down")

# %% [markdown] tags=["exercise"]
# **2.** ★ (1 point, derivation) For $r = 1.2\,d$, at what least distance between any two agents does the extension
# guarantee that no links cross? Give it as a multiple of $d$, to three significant digits.

# %% tags=["answer"]
safe = ...

# %% tags=["solution"]
safe = 1.2 / np.sqrt(2)

# %% tags=["check"]
grade(safe, 0.848528, digits=3, hint="the extension is stated for r; put in what r is")

# %% [markdown] tags=["exercise"]
# **3.** ★★ (2 points, design) Build thirteen agents: an FCC site with its twelve nearest neighbours, as an array
# `thirteen` of shape (13, 3) with scale $d = 7$. More than $3n - 6 = 33$ links are possible in space.

# %% tags=["answer"]
thirteen = ...

# %% tags=["solution"]
steps = [(a, b, c) for a in (-1, 0, 1) for b in (-1, 0, 1) for c in (-1, 0, 1) if abs(a) + abs(b) + abs(c) in (0, 2)]
thirteen = np.array(steps) * d / np.sqrt(2)
print(len(lattice.links(thirteen, r)), "links")

# %% tags=["check"]
grade(
    thirteen,
    lambda x: np.shape(x) == (13, 3) and lattice.is_alpha_lattice(x, 7.0, 8.4) and len(lattice.links(x, 8.4)) == 36,
    form="list",
    hint="every agent of the shell has the centre and four of the shell as neighbours",
)

# %% [markdown] tags=["exercise"]
# **4.** ★ (1 point, derivation) The slides print (ii) for all $n$, without $n \ge 3$. How many links has the
# lattice of 2 agents, and how many does $3n - 6$ allow? Give the list of both.

# %% tags=["answer"]
links_of_two = ...

# %% tags=["solution"]
links_of_two = [len(lattice.links(lattice.line(2, d), r)), 3 * 2 - 6]

# %% tags=["check"]
grade(links_of_two, [1, 0], hint="count the links of two agents at the distance d")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, counterexample) Counterexample hunt: give four agents in the plane, an array of shape (4, 2),
# two of whose links cross, for $r = 8.4$. (By the extension some two of them are nearer than $r/\sqrt2$.)

# %% tags=["answer"]
crossing = ...

# %% tags=["solution"]
crossing = [[0.0, 0.0], [5.0, 0.0], [5.0, 5.0], [0.0, 5.0]]  # the diagonals are links

# %% tags=["check"]
grade(
    crossing,
    lambda x: (
        np.shape(x) == (4, 2)
        and fl.min_distance(np.array(x, float)) > 0.0
        and np.linalg.matrix_rank(np.subtract(x, x[0])) == 2
        and len(lattice.crossings(np.array(x, float), lattice.links(np.array(x, float), 8.4))) > 0
    ),
    form="list",
    hint="which links could cross in a square?",
)

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) Theorem 5(i) is proved by showing that no two links of a lattice cross. Why does that
# prove planarity in the plane and nothing in space? Name a net that can be drawn in space without crossings and is
# not planar. Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# A graph is planar if it can be drawn in the plane without crossing edges. In the plane the positions of the agents
# are such a drawing. In space links that do not meet are the rule: any graph can be drawn in space without
# crossings, for instance the complete graph of five nodes in general position, which is not planar by Kuratowski's
# theorem.
#
# **Rubric, a point each:** planarity is about a drawing in the plane; an example such as the complete graph of five
# nodes, or K3,3.

# %% [markdown] tags=["exercise"]
# **7.** ★ (1 point, player) Move the slider of $\kappa$ above. At which least value on it is the patch no α-lattice
# any more, though it still was at the value before? (Three significant digits.)

# %% tags=["answer"]
too_far = ...

# %% tags=["solution"]
too_far = 1.75  # √3 = 1.732 lies between 1.7 and 1.75

# %% tags=["check"]
grade(too_far, 1.75, digits=3, hint="the title says whether it is a lattice")

# %% [markdown] tags=["exercise"]
# **8.** ★★★ (3 points, proof) Prove: in an α-lattice in the plane with $\kappa > 1$ no agent has more than six
# neighbours, and if one has six, they form a regular hexagon. (Look at the angle at the agent between two
# neighbours.) Does the same count hold for every net in which all pairs are at least $d$ apart and $r = 1.2\,d$?

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Let $j$ and $k$ be neighbours of $i$. Both are $d$ from $i$, and $\|q_j - q_k\| \ge d$: if they are neighbours it
# is $d$, if not it is at least $r > d$. In the triangle with two sides $d$ and the third at least $d$ the angle at
# $i$ is at least 60°. The angles between successive neighbours add up to 360°, so there are at most six, and if six,
# each angle is exactly 60°: a regular hexagon. For the second question: neighbours may now be up to $1.2\,d$ away.
# Two neighbours at $1.2\,d$ that are $d$ apart subtend the angle $2\arcsin(1/2.4) = 49.2°$, and seven such angles
# are 344.6°, less than 360°. So seven neighbours are possible.
#
# **Rubric, a point each:** the angle between two neighbours is at least 60°; six of them fill the circle and are
# equal; for the wider net seven fit, with a computation.

# %% [markdown] tags=["exercise"]
# **9.** ★★★ (3 points, project) Open project, about two weeks: are there α-lattices in the plane that are not pieces
# of the triangular lattice, for $\kappa = 1.2$, and with how many links? Search (for instance by minimising $V$ from
# random starts, or by gluing squares and triangles), draw what you find, count links, test rigidity, and state as a
# conjecture or prove what you can. Hand in a page with figures.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# A good answer finds rows of squares and triangles (the snub and elongated tilings are α-lattices, as square
# diagonals $\sqrt2\,d$ exceed $1.2\,d$), flexible chains and rings with fewer links than rigidity needs, and none
# with more links than the triangular pieces, as Harborth proved. It states clearly what was searched and what was
# proved.
#
# **Rubric, a point each:** examples that the library confirms as α-lattices; a systematic count of links and
# rigidity against a stated method of search; a statement that separates conjecture from proof.
