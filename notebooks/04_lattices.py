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
# **Aims.** Build lattices, measure how far a configuration is from one, test Theorem 5 claim by claim, and find the one
# that is false in space.
#
# An *α-lattice* of scale $d$ and ratio $\kappa = r/d$ is a configuration in which every agent is exactly $d$ away from
# each of its neighbours, the agents nearer than $r$ (Olfati-Saber 2006, Definition 1). Which patterns qualify depends
# on the distance of *second* neighbours: it must not fall below $r$.

# %%
import numpy as np

import flockana as fl
from flockana import lattice, plots
from flockana.course import grade

for name in ("triangular", "square", "honeycomb", "simple_cubic", "fcc", "hcp", "bcc"):
    print(f"{name:>12}: κ at most {lattice.max_ratio(name):.4f}")

# %%
d, r = 7.0, 8.4
q = lattice.hexagonal_patch(3, d)
pairs = lattice.links(q, r)
print(f"{len(q)} agents, {len(pairs)} links, α-lattice: {lattice.is_alpha_lattice(q, d, r)}")
print(f"Theorem 5 allows 3n − 6 = {lattice.planar_bound(len(q))}; Harborth's sharp bound is {lattice.harborth(len(q))}")

# %% [markdown]
# The same 37 places, with the range moved: below $\kappa = 1$ there are no links, up to $\sqrt3$ those of the lattice,
# and beyond it the second neighbours come into range.

# %%
from flockana.course.frames import slider


def with_range(ax, ratio):
    title = f"α-lattice: {lattice.is_alpha_lattice(q, d, ratio * d)}, {len(lattice.links(q, ratio * d))} links"
    plots.configuration(q, d=d, r=ratio * d, ax=ax, bar=False, title=title)


kappas = (0.95, 1.05, 1.2, 1.4, 1.6, 1.7, 1.75, 1.9, 2.05)
slider(with_range, kappas, name="κ", title="links of a patch of the hexagonal lattice", size=(4.6, 4.6), start=2)

# %% [markdown]
# ## Theorem 5
#
# > **Theorem 5** (Olfati-Saber 2006). Let $q$ be an α-lattice of scale $d > 0$ and ratio $\kappa > 1$ with distinct
# > nodes. Then (i) its net is planar, $m = 2, 3$; (ii) it has at most $3n - 6$ links, $m = 2$, $n \ge 3$; (iii) with
# > $n > m + 1$ nodes it is not complete, $m = 1, 2, 3$.
#
# In the plane (i) holds: if two links crossed, each of the length $d$, two of their ends would be at most $d/\sqrt2$
# apart, hence neighbours, and neighbours are exactly $d$ apart. In space it is false (below). The sharp bound in (ii)
# is $\lfloor 3n - \sqrt{12n-3}\rfloor$ (Harborth 1974), which hexagonal spirals reach.
#
# ## What a flock really ends in
#
# Algorithm 2 ends near a lattice, not in one: the γ-agent's pull compresses it. Colour and shape of an agent tell its
# number of neighbours; six of them is the perfect interior.

# %%
run = fl.scenario("paper-flocking").run()
end = run.q[-1] - run.q[-1].mean(axis=0)
net = lattice.links(end, r)
length = np.linalg.norm(end[net[:, 0]] - end[net[:, 1]], axis=1)
plots.defect_map(end, net, lattice.coordination(len(end), net), strain=length / d - 1)
print(f"largest strain {lattice.strain(end, d, r):.3f}, crossings {len(lattice.crossings(end, net))}")

# %% [markdown]
# Theorem 5 is about lattices, and this state is none: what it says is vacuous here. An extension needs no lattice: **if
# all pairs are farther apart than $r/\sqrt2$, no two links cross**. (Two crossing links are the diagonals of a convex
# quadrilateral, one of whose sides is at most $1/\sqrt2$ of the longer diagonal.) It is vacuous too, `extension` below,
# because the closest pair is a little nearer than $r/\sqrt2$. But the argument bounds that side by the links that there
# are, not by the range: with $\ell$ the longest link, pairs farther apart than $\ell/\sqrt2$ suffice. That holds here
# (`extension-lengths`).

# %%
print(fl.verify("os-5", q=end, d=d, r=r))

# %% tags=["facts"]
said = fl.verify("os-5", q=end, d=d, r=r)
assert [said.claim(name).status for name in ("i", "extension", "extension-lengths")] == [
    "vacuous",
    "vacuous",
    "verified",
]

# %% [markdown]
# ## In space, planarity fails
#
# The theorem's proof shows that edges do not cross. In the plane that *is* planarity; in space it is nothing of the
# sort. Eight agents of a face-centred cubic lattice suffice (erratum E5):

# %%
eight = np.array([[0, 0, 0], [1, 0, 1], [2, 1, 1], [1, 1, 0], [2, 2, 0], [2, 1, -1], [1, 0, -1], [2, 0, 0]])
fragment = eight * d / np.sqrt(2)
edges = lattice.links(fragment, r)
print(f"crossings: {len(lattice.crossings(fragment, edges))}, planar: {lattice.is_planar(8, edges)}")
print(lattice.kuratowski(8, edges))
figure, ax = plots.subplots(m=3, size=(5, 4.5))
_ = plots.configuration(fragment, d=d, r=r, ax=ax, bar=False)

# %% [markdown]
# ## Rigidity
#
# A framework whose only infinitesimal motions are translations and rotations holds its shape. Its rigidity matrix says
# so, and its links carry a self-stress where there are more of them than needed:

# %%
print(lattice.rigidity(q, pairs))

# %% [markdown]
# ## Summary
#
# - Which patterns are α-lattices is decided by the second neighbours.
# - Links of pairs farther apart than $\ell/\sqrt2$ do not cross, lattice or not.
# - In space a lattice's net need not be planar.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, derivation) How many links can an α-lattice of 100 agents in the plane have at most? (A whole
# number.)

# %% tags=["answer"]
most = ...

# %% tags=["solution"]
most = lattice.harborth(100)

# %% tags=["check"]
grade(most, 265, hint="Harborth's number, not 3n − 6")

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
# **4.** ★ (1 point, derivation) Theorem 5 bounds the links of 2 agents by $3n - 6$. Is that right? (`True` or `False`.)

# %% tags=["answer"]
bound_holds_for_two = ...

# %% tags=["solution"]
bound_holds_for_two = bool(len(lattice.links(lattice.line(2, d), r)) <= 3 * 2 - 6)

# %% tags=["check"]
grade(bound_holds_for_two, False, hint="erratum E6")

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
        np.shape(x) == (4, 2) and len(lattice.crossings(np.array(x, float), lattice.links(np.array(x, float), 8.4))) > 0
    ),
    form="list",
    hint="which links could cross in a square?",
)

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) Theorem 5(i) is proved by showing that no two links of a lattice cross. Why does that
# prove planarity in the plane and nothing in space? Name a net that can be drawn in space without crossings and is not
# planar. In your own words, at least 30 of them. (The check counts words, and your lecturer reads the text.)

# %% tags=["answer"]
planarity = ...

# %% tags=["solution"]
planarity = """A graph is planar if it can be drawn in the plane without crossing edges. In the plane the positions
of the agents are such a drawing. In space links that do not meet are the rule: any graph can be drawn in space
without crossings, for instance the complete graph of five nodes in general position, which is not planar by
Kuratowski's theorem."""
# Rubric, a point each:
# planarity is about a drawing in the plane; an example such as the complete graph of five
# nodes, or K3,3.

# %% tags=["check"]
grade(planarity, lambda text: len(text.split()) >= 30, form="text", hint="a text of at least 30 words")
