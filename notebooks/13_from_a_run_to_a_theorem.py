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
# # From a run to a theorem
#
# **Aims.** See what a simulation leaves open, turn "it looks as if it flocks" into a statement that no rounding error
# can touch, read its certificate, and let other code check it.
#
# Three agents under Algorithm 2, one of them off its place by a push. Does *this* start flock?

# %%
import tempfile
from pathlib import Path

import numpy as np

import flockana as fl
from flockana import lattice, plots
from flockana.course import grade

law = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
rest = fl.find_equilibrium(law, lattice.hexagonal_spiral(3, 7.0))
start = rest.q + 0.9 * np.array([[1.0, 0.0], [-0.5, 0.4], [-0.5, -0.4]])
still = np.zeros_like(start)
run = fl.simulate(law, start, still, (0.0, 8.0))
_ = plots.measure(run, "normalised_velocity_mismatch")

# %% [markdown]
# The mismatch falls, and falls. But the integrator rounds, eight seconds are not for ever, and the equilibrium itself
# was computed only to fifteen digits. What would a proof need?
#
# ## A basin
#
# In the frame of the centre of mass $\dot x = v$, $\dot v = -\nabla U(x) - D(x)v$ with $U = c_1^\alpha V + \tfrac12
# c_1^\gamma\|x\|^2$ and $D = c_2^\gamma I + c_2^\alpha\hat L(x)$. Turning the triangle costs nothing, so it is an
# *orbit* of equilibria. Let $w$ be the displacement from the nearest of them. If the curvature of $U$ in the direction
# of $w$ is at least $k(\xi)$ at the distance $\xi$ from the orbit, for $0 \le \xi \le \|w\|$, then with $G'' = k$,
# $G(0) = G'(0) = 0$
#
# $$U - U^* \ge G(\|w\|), \qquad \langle\nabla U, w\rangle \ge \|w\|\,G'(\|w\|).$$
#
# > **Theorem.** Within the distance $\xi_0$ of the orbit let all curvatures as above be bounded below by $k$, with
# > $G' > 0$ on $(0, \xi_0]$, and let $c_2^\gamma > 0$. Then every solution that starts at most $\xi_0$ from the orbit
# > with an energy $U + \tfrac12\|v\|^2$ below $U^* + G(\xi_0)$ stays so near, and converges to the orbit with matched
# > velocities.
#
# For a state at the distance $\xi_0$ has at least the energy $U^* + G(\xi_0)$, which a start with less never reaches,
# because the energy only falls. By LaSalle's principle the solution approaches states that stay at rest, where $\nabla
# U = 0$; by the second inequality these have $w = 0$. (That it comes to rest at *one* point of the orbit, and how fast,
# the library proves by a strict Lyapunov function.)
#
# `certify` bounds every pair's stress and slope by *ball arithmetic*, over all lengths that the ball allows, and takes
# the largest $\xi_0$ that it can prove.

# %%
basin = fl.certify(rest)
print(f"radius {basin.share:.4f} d, level {float(basin.level):.3f}, no two agents nearer than {float(basin.distance)}")
print(f"U + |v|^2/2 - U* is at most {float(basin.overshoot):.3g} exp(-{2 * float(basin.rate):.3f} t) of its start")
print(f"the net stays connected: {basin.connected}")

# %% [markdown]
# Is our start in it? `above` gives upper bounds of the distance to the orbit and of the energy above it; `holds` is
# True only if both are certainly small enough.

# %%
for t, q, p in zip(run.t, run.q, run.p, strict=True):
    distance, energy = basin.above(q, p)
    if basin.holds(q, p):
        print(f"at t = {t:.2f} the state is in the basin: distance {float(distance):.3f}, energy {float(energy):.3f}")
        break
    if t == run.t[0]:
        print(
            f"the start is not: distance {float(distance):.3f} > {float(basin.radius)}, or energy {float(energy):.2f}"
        )

# %% [markdown]
# From that state on, everything is proved: it converges to the triangle, with matched velocities, without a collision.
# That the *computed* state is near the true one at that time is the integrator's word; to enclose the run itself takes
# a tube around the solution.
#
# ## A tube
#
# `enclose` takes the step from the computed state to the true one. It carries a *set* along that provably holds the
# solution: a Taylor polynomial, with its remainder bounded over all states that the step may meet, and a second-order
# step where a pair crosses a distance at which its law changes its piece. Three agents at rest, none in the others'
# range, first numerically, then rigorously:

# %%
q0 = np.array([[-4.625, -2.5], [4.5, -2.75], [0.25, 5.5]])
numerical = fl.simulate(law, q0, still, (0.0, 1.25))
tube = fl.enclose(law, q0, still, (0.0, 1.25))
nearest = tube.min_distance()
print(f"{tube.status}: {len(tube.taken)} steps, at the end every coordinate within {tube.radii[-1].max():.1e}")
print(f"no two agents came nearer than {nearest.lower:.4f}, between the steps included")

# %%
import matplotlib.pyplot as plt

bounds = np.array(
    [[[float(x.lower()), float(x.upper())] for x in tube.distances_during(k)] for k in range(len(tube.taken))]
)
fig, ax = plt.subplots()
for (i, j), (low, high) in zip(tube.pairs, bounds.transpose(1, 2, 0), strict=True):
    ax.fill_between(tube.t, [*low, low[-1]], [*high, high[-1]], step="post", alpha=0.5, label=f"{i}, {j}: proved")
    ax.plot(numerical.t, np.linalg.norm(numerical.q[:, j] - numerical.q[:, i], axis=1), "k:", linewidth=1.0)
ax.axhline(law.alpha.r, color="grey", linewidth=0.8)
ax.annotate("r: a link forms", (0.0, law.alpha.r), va="bottom", fontsize=8)
ax.set(xlabel="time", ylabel="distance of a pair")
_ = ax.legend(loc="upper right")

# %% [markdown]
# The steps of the band are the steps of the proof: each box holds the distance at *all* times of its step. The dotted
# lines are the computed run. (The law enclosed has one tenth where the simulation has the binary number next to 0.1.)
# And the end of the tube, all of it, lies in the basin. So all of Theorem 3, its limit included, holds for this start:

# %%
print("in the basin:", tube.ends_in(basin))
verdict = fl.verify("os-3", tube, basin=basin)
print(verdict.status, verdict.rigour, {claim.name: claim.status for claim in verdict.claims})

# %% [markdown]
# ## Where a tube breaks
#
# Now seven agents, not from one start but from a small box of them, again with links that form on the way:

# %%
loose = np.round(8.0 * np.random.default_rng(7).uniform(-0.5, 0.5, (7, 2))) / 16.0
wide = np.round(8.0 * (1.22 * lattice.hexagonal_patch(1, 7.0) + loose)) / 8.0
box = fl.enclose(law, wide, np.zeros_like(wide), (0.0, 0.75), radius=(0.002, 0.0))
widths = box.radii[:, 0].max(axis=(1, 2))
for k in range(0, len(box.t), max(1, len(box.t) // 8)):
    print(f"t = {box.t[k]:.3f}: the positions are known to {widths[k]:.1e}")
print(box.status, "-", box.message)

# %% [markdown]
# It breaks while pairs lie about a switching distance. There the pair law is only C¹, so the tube crosses it by
# second-order steps, which add the more to a set the longer they last; the wider the set, the longer some state in it
# is about the switch, and the wider it leaves. Seven agents have many such pairs at about the same time. From one start
# (`radius=0`) the set is as narrow as rounding when the first links form, each crossing is short, and the tube reaches
# the end of the same time span: that takes about a minute.
#
# ## Past an obstacle
#
# Algorithm 3 among spheres is enclosed too. An agent comes into reach of one and passes: how near does it come, and
# does the energy of Theorem 6 fall at *all* times, not at samples?

# %%
gains = fl.Gains(c1_beta=20.0, c2_beta=4.0, c1_gamma=1.0, c2_gamma=1.0)
reach = fl.BetaInteraction(d=2.0, r=2.5, h=0.5)
sphere = fl.Sphere((6.0, 2.5), 1.0)
among = fl.Algorithm3(gains=gains, target=fl.StaticTarget((12.0, 0.0)), beta=reach, obstacles=(sphere,))
passing = fl.enclose(among, [[4.0, 0.0]], [[6.0, 0.0]], (0.0, 0.5))
print(f"the clearance is at least {passing.min_clearance().lower:.4f}, where the agent is left alone beyond {reach.d}")
print(fl.verify("os-6", passing))

# %% [markdown]
# ## What others find
#
# The certified radius is a lower bound of the true basin's. Samples tell how far from the truth it may be, and prove
# nothing:

# %%
sampled = fl.sample_basin(basin, np.linspace(0.03, 0.9, 7) * 7.0, runs=8, t_end=10.0)
_ = plots.sampled_basin(sampled)

# %% [markdown]
# ## A certificate
#
# `write_certificate` writes what was proved, and everything that is needed to verify it: exact parameters, positions in
# hexadecimal, the bounds of the pairs in each shell. `flockana check FILE`, or `fl.check_certificate`, verifies it with
# code of its own, which shares only the scalar functions with the code that proved.

# %%
file = Path(tempfile.mkdtemp()) / "triangle.json"
fl.write_certificate(basin, file)
checked = fl.check_certificate(file)
print(*checked.steps, sep="\n")

# %% [markdown]
# The run has one too: polynomials beside the solution, whose distance from it the checker bounds by another theorem
# than the one that the tube rests on, and the basin's certificate within.

# %%

of_run = file.with_name("run.json")
fl.write_tube_certificate(tube, of_run, basin=basin)
of_tube = [step for step in fl.check_certificate(of_run).steps if not step.startswith("basin: ")]
print(*of_tube, sep="\n")

# %% [markdown]
# ## Summary
#
# - A basin is certified by bounding curvature in all states of a ball; its certificate is checked by other code.
# - A tube encloses the solution itself, so that a run becomes a proof.
# - A certified radius is a lower bound; samples show how far it may be from the truth.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★★ (2 points, derivation) Two agents under Algorithm 1, 7 apart. A displacement by $\xi$ over all coordinates
# stretches the link by $\sqrt2\,\xi$, and at $r = 8.4$ the link breaks. What is the largest $\xi_0/d$ that any proof
# could reach? (Four significant digits.)

# %% tags=["answer"]
largest = ...

# %% tags=["solution"]
largest = 1.4 / np.sqrt(2) / 7.0

# %% tags=["check"]
grade(largest, 0.14142136, digits=4, hint="how much longer may the link become?")

# %% [markdown] tags=["exercise"]
# **2.** ★ (1 point, reading) And what does `certify` reach for these two, in d? (Two significant digits.)

# %% tags=["answer"]
reached = ...

# %% tags=["solution"]
reached = fl.certify([[0.0, 0.0], [7.0, 0.0]], law=fl.Algorithm1()).share

# %% tags=["check"]
grade(reached, 0.07038571, digits=2, hint="fl.certify takes positions and a law")

# %% [markdown] tags=["exercise"]
# **3.** ★★ (2 points, derivation) Along a ray the curvature of $U$ is at least $k(\xi) = 3 - \tfrac32\xi$ up to the
# distance $\xi = 2$. Which energy above $U^*$ must a state have to leave the ball of radius 2? (Compute $G(2)$,
# exactly.)

# %% tags=["answer"]
level = ...

# %% tags=["solution"]
level = 3.0 * 2.0**2 / 2.0 - 1.5 * 2.0**3 / 6.0  # G(ξ) = 3 ξ²/2 − 1.5 ξ³/6

# %% tags=["check"]
grade(level, 4.0, hint="integrate k twice, from 0")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, derivation) Of a basin it is certified that the energy above $U^*$ is at most
# $e^{-2\cdot 0.4\,t}$ times that at the start. After what time has it surely fallen to a millionth of that? (Four
# significant digits.)

# %% tags=["answer"]
wait = ...

# %% tags=["solution"]
wait = np.log(1e6) / 0.8

# %% tags=["check"]
grade(wait, 17.2693882, digits=4, hint="mind the factor 2")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, words) In your own words, at least 30 of them: the tube ends in the basin. What is proved of
# this start that the run alone does not show, and what is still not proved? (A text; the check counts words, and your
# lecturer reads it.)

# %% tags=["answer"]
proved = ...

# %% tags=["solution"]
proved = """Proved is that the true solution, not only the computed one, enters the basin, hence converges to the
triangle with matched velocities and never collides, for all time. Not proved is anything about other
starts outside the tube and the basin, or about a law with other parameters."""
# Rubric, a point each:
# the true solution is enclosed, not only computed; from the basin convergence follows for all
# time, without collisions; other starts and parameters remain open.

# %% tags=["check"]
grade(proved, lambda text: len(text.split()) >= 30, form="text", hint="a text of at least 30 words")
