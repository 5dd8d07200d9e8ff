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
# **Aims.** See what a simulation leaves open; prove a basin of attraction from bounds on curvature; enclose a
# solution by intervals; read a certificate, and let other code check it.
#
# ## A scene
#
# The drones are to fly over a crowd, and the authority asks: "You have shown us a thousand simulations. Can you
# *prove* that from this start they end in formation and never touch?" Simulations round, they stop, and they look at
# instants. The engineer has two answers, and this lecture has both: near the formation, a *basin*, a set of states
# from which everything provably converges; and from the start to the basin, a *tube*, a band that provably contains
# the true motion. **Which statements can be made that no rounding error touches, and what do they cost?**
#
# ## One agent on a line
#
# One agent is held by a spring of stiffness between 1 and 3, we do not know it better, and is damped. Its potential
# $U$ has the minimum $U^*$ at 0, and at the distance $\xi$ it is at least $\tfrac12\xi^2$, because its second
# derivative is at least 1. Whoever wants to leave the interval $|x| \le 2$ must pass a point with $U \ge U^* + 2$.
# The total energy $U + \tfrac12v^2$ only falls. So from an energy below $U^* + 2$, and from inside, it never leaves.
# Nothing in this argument asked for the exact stiffness, nor for a solution: *a lower bound of the curvature, and an
# energy that falls, are enough*. That is the whole idea; the rest is to do it for a flock, whose equilibrium is not
# a point, and to bound the curvature with a computer that rounds.
#
# ## Three agents
#
# Three agents under Algorithm 2 stand near a triangle, each of them off its place. Does *this* start flock?

# %%
import tempfile
from pathlib import Path

import numpy as np

import flockana as fl
from flockana import lattice, plots
from flockana.course import Prediction, figures, grade

law = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
rest = fl.find_equilibrium(law, lattice.hexagonal_spiral(3, 7.0))
start = rest.q + 0.9 * np.array([[1.0, 0.0], [-0.5, 0.4], [-0.5, -0.4]])
still = np.zeros_like(start)
run = fl.simulate(law, start, still, (0.0, 8.0))
_ = plots.measure(run, "normalised_velocity_mismatch")
run.player(height=420)

# %% [markdown]
# **Figure 13.1.** The velocity mismatch $\tilde K$ of three agents falls by many powers of ten, and then stays at
# the level of rounding.
#
# It looks convincing. What is open? The integrator makes an error in every step; eight time units are not for ever;
# the samples are instants; and the equilibrium itself was computed to fifteen digits only.
#
# ## A basin
#
# In the frame of the centre of mass (lecture 03) $\dot x = v$, $\dot v = -\nabla U(x) - D(x)v$ with $U = c_1^\alpha V +
# \tfrac12 c_1^\gamma\|x\|^2$ and $D = c_2^\gamma I + c_2^\alpha\hat L(x)$. Turning the triangle costs nothing, so it is
# not one equilibrium but an *orbit* of equilibria, a circle in the space of all positions. Let $x^*$ be the point of
# the orbit nearest to $x$, and $\tilde x = x - x^*$ the displacement. Suppose that we have a function $\underline
# S(\xi)$ with this property: *at every state at the distance $\xi \le \xi_0$ from the orbit the curvature of $U$ in the
# direction of its displacement is at least $\underline S(\xi)$*. (The curvature in the direction of a unit vector $e$
# is the second derivative of $U(x + \xi e)$ with respect to $\xi$.) Integrate it twice: $G'' = \underline S$, $G(0) =
# G'(0) = 0$. For the spring of the beginning $\underline S = 1$, so $G = \tfrac12\xi^2$ and $G(2) = 2$.
#
# > **Lemma.** At every state at a distance $\|\tilde x\| \le \xi_0$ from the orbit
# >
# > $$U - U^* \ge G(\|\tilde x\|), \qquad \langle\nabla U, \tilde x\rangle \ge \|\tilde x\|\,G'(\|\tilde x\|) .$$
#
# *Proof.* Let $e = \tilde x/\|\tilde x\|$ and $f(\xi) = U(x^* + \xi e)$ for $0 \le \xi \le \|\tilde x\|$.
#
# 1. The nearest point of the orbit to $x^* + \xi e$ is still $x^*$. Suppose that some $x'$ of the orbit is nearer, at
#    less than $\xi$. From $x^* + \xi e$ to $x$ it is $\|\tilde x\| - \xi$, so by the triangle inequality $x'$ is less
#    than $\xi + \|\tilde x\| - \xi = \|\tilde x\|$ from $x$: nearer than the nearest, a contradiction. So $e$ is the
#    direction of the displacement all along the ray, and $f''(\xi) \ge \underline S(\xi)$.
# 2. $x^*$ is an equilibrium, so $f'(0) = \langle\nabla U(x^*), e\rangle = 0$. Integrate 1: $f'(\xi) \ge G'(\xi)$.
# 3. Integrate again: $f(\xi) - U^* \ge G(\xi)$. At $\xi = \|\tilde x\|$ this is the first claim.
# 4. $\langle\nabla U, \tilde x\rangle = \|\tilde x\|f'(\|\tilde x\|) \ge \|\tilde x\|G'(\|\tilde x\|)$ by 2.
#    $\square$
#
# > **Theorem (basin).** Let $c_2^\gamma > 0$, and let $G' > 0$ on $(0, \xi_0]$. Then every solution that starts at
# > most $\xi_0$ from the orbit with an energy $U + \tfrac12\|v\|^2 < U^* + G(\xi_0)$ stays within $\xi_0$ of it for
# > all times, and converges to the orbit with $v \to 0$.
#
# *Proof.*
#
# 1. At the distance $\xi_0$ a state has at least the energy $U^* + G(\xi_0)$, by the lemma. The solution starts with
#    less, and its energy does not rise. The distance from the orbit is continuous in time, so it never reaches
#    $\xi_0$.
# 2. The states within $\xi_0$ of the orbit with energies up to that of the start form a compact set: the orbit is
#    compact, and $\tfrac12\|v\|^2$ is bounded by the energy. By 1 the solution stays in it.
# 3. By LaSalle's theorem (lecture 00a) the solution approaches an invariant set on which the energy is constant. Its
#    rate is at most $-c_2^\gamma\|v\|^2$, so there $v = 0$, and by invariance $\nabla U = 0$.
# 4. By the second inequality of the lemma $0 = \langle\nabla U, \tilde x\rangle \ge \|\tilde x\|G'(\|\tilde x\|)$,
#    and $G' > 0$, so $\tilde x = 0$: the state is on the orbit. $\square$
#
# That the solution comes to rest at *one* point of the orbit, instead of creeping along it, and how fast, needs
# more: the library proves both by a strict Lyapunov function, the energy plus a small multiple of
# $\langle v, \tilde x\rangle$, which falls exponentially.

# %%
figure, ax = plots.subplots(size=(5, 4.4))
_ = figures.orbit_ball_level(ax=ax)

# %% [markdown]
# **Figure 13.2.** The orbit of equilibria (circle), the states within $\xi_0$ of it (grey), a level set of the
# energy that lies inside (dashed), and a solution that starts in it: it cannot cross the dashed curves, and ends on
# the circle, not necessarily where it was nearest to it at the start.
#
# ## Where do the bounds come from?
#
# The curvature of $U$ is a sum over pairs. Take one pair with the distance $y$, the potential $\psi(y)$ and the force
# $f = \psi'$ along it (negative where it repels). Let $e$ be the unit vector along the pair, and let the difference of
# the two positions change by a small vector $z$, with the part $z_\perp$ across $e$:
#
# 1. The new distance is $\|ye + z\| = y + \langle e, z\rangle + \tfrac1{2y}\|z_\perp\|^2 + \dots$: moving across
#    lengthens a pair, too, but only to second order.
# 2. Put this into $\psi$ and collect the terms of second order:
#    $\tfrac12\bigl[f'(y)\,\langle e, z\rangle^2 + \tfrac{f(y)}y\|z_\perp\|^2\bigr]$.
#
# So the curvature of a pair is its *slope* $f'$ along the pair, its *stress* $f/y$ across it, and in between in all
# other directions. A pair at the distance $d$ has no force, hence no stress: it resists being stretched, with the slope
# $f'(7) = 223$ here, and does not resist being turned. A compressed pair has a negative stress, $-3.5$ at 6.9: like a
# rod under pressure it wants to give way sideways. Stiff slopes and the γ-agent must outweigh that.
#
# How much can a length change? If the agents move by at most $\xi$ together, then
#
# $$\|\tilde x_j - \tilde x_i\| \le \|\tilde x_i\| + \|\tilde x_j\| \le
#   \sqrt2\,\sqrt{\|\tilde x_i\|^2 + \|\tilde x_j\|^2} \le \sqrt2\,\xi .$$
#
# So one needs bounds of $f'$ and $f/y$ over an *interval* of lengths.
#
# Numbers of a computer round; intervals need not. In *interval arithmetic* every quantity is a pair of bounds, and
# every operation rounds the lower one down and the upper one up. So $[1,2] + [3,4] = [4,6]$,
# $[1,2]\cdot[-1,3] = [-2,6]$, and a function evaluated on an interval returns an interval that certainly holds all
# its values. It may return too much: $x - x$ on $[0,1]$ gives $[-1,1]$. Bounds are true, not tight; tightness is
# what one works for, by cutting intervals into pieces.
#
# `certify` bounds every pair's stress and slope by *ball arithmetic* (an interval as midpoint and radius), over all
# lengths that the distance $\xi_0$ allows, and takes the largest $\xi_0$ that it can prove.

# %%
basin = fl.certify(rest)

# %% tags=["predict"]
guess = ...
Prediction(
    "Within which distance of the orbit, as a share of d, is convergence proved for three agents?",
    guess,
    float(basin.share),
)

# %%
print(f"radius {basin.share:.4f} d, level {float(basin.level):.3f}, no two agents nearer than {float(basin.distance)}")
print(f"U + |v|^2/2 - U* is at most {float(basin.overshoot):.3g} exp(-{2 * float(basin.rate):.3f} t) of its start")
print(f"the net stays connected: {basin.connected}")

# %% [markdown]
# Read the lines by hand. The radius is $0.0592\cdot7 = 0.414$. The sides of the triangle are 6.989 long, so within the
# basin every length lies between $6.989 - \sqrt2\cdot0.414 = 6.403$, the least distance of the first line, and 7.574.
# That is below $r = 8.4$, so no link can break: this is the third line. The second one says that the energy above $U^*$
# has certainly fallen to a thousandth after $\ln(1770)/0.24 = 31$ time units. The run did that in about one: a
# certified rate is a lower bound, too.
#
# Is our start in it? `above` gives upper bounds of the distance to the orbit and of the energy above it; `holds` is
# `True` only if both are certainly small enough.

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
# From that state on, everything is proved: convergence to the triangle, matched velocities, no collision. But that
# the *computed* state is near the true one at that time is the integrator's word. To enclose the motion itself takes
# a tube.
#
# ## A tube
#
# Let $\dot x = f(x)$, and let the state at some time lie in a box $[x]$, a product of intervals. How far can it get
# in a step $\Delta t$? Guess a larger box $[y]$ and check one inclusion:
#
# > **Theorem (enclosure).** Let $[f]$ be a box that contains all values of $f$ on $[y]$. If $x + [0,\Delta t]\,[f]$
# > lies in the interior of $[y]$ for every $x \in [x]$, then every solution that starts at such an $x$ stays in
# > $[y]$ for the time $\Delta t$, and at the end lies in $x + \Delta t\,[f]$.
#
# *Proof.* Suppose that a solution leaves $[y]$, and let $t_1 \le \Delta t$ be the first time at which it is on the
# boundary. Up to $t_1$ it is in $[y]$, so $x(t_1) = x(0) + \int_0^{t_1}f(x(t))\,dt$ lies in $x(0) + t_1[f]$, because
# the mean of values in a box, which is convex, is in that box. By hypothesis that is in the *interior* of $[y]$: a
# contradiction. The last claim is the same integral at $\Delta t$. $\square$
#
# *By hand.* Let $\dot x = -x$ and $[x] = [0.9, 1]$, and step by $\Delta t = 0.1$.
#
# 1. Guess $[y] = [0.8, 1.05]$. On it $[f] = [-1.05, -0.8]$, so $x + [0, \Delta t][f]$ reaches down to
#    $0.9 - 0.105 = 0.795 < 0.8$. The inclusion fails. That says nothing about the solution: the guess was too small.
# 2. Guess $[y] = [0.75, 1.05]$. Now $[f] = [-1.05, -0.75]$, all values lie in $[0.795, 1]$, and that is in the interior
#    of $[y]$. So it is proved that the solutions stay in $[0.75, 1.05]$.
# 3. At the end they lie in $[0.9 - 0.105,\ 1 - 0.075] = [0.795, 0.925]$.
#
# <details><summary>How good the box is</summary>
#
# The truth is $[0.9e^{-0.1}, e^{-0.1}] = [0.8144, 0.9048]$, narrower than at the start, while the box has become
# *wider*: 0.13 instead of 0.1. The reason is that it lets a solution start at 0.9 and move with the speed that only one
# at 1.05 has. One more term of Taylor's formula knows better. As $\ddot x = x$, one has
# $x(\Delta t) \in (1 - \Delta t)x + \tfrac12\Delta t^2[y]$, which is $[0.81375, 0.90525]$, of width 0.0915.
#
# </details>
#
# So a wild guess, once checked, is a proof. The box from the first term alone grows in every step, so one uses Taylor's
# formula, with the remainder bounded on $[y]$, and carries the box in turning coordinates.
# `enclose` does that, with a second-order step where a pair crosses a distance at which its law changes its piece.
# Three agents at rest, none in the others' range, first numerically, then rigorously:

# %%
q0 = np.array([[-4.625, -2.5], [4.5, -2.75], [0.25, 5.5]])
numerical = fl.simulate(law, q0, still, (0.0, 1.25))
tube = fl.enclose(law, q0, still, (0.0, 1.25))
nearest = tube.min_distance()
print(f"{tube.status}: {len(tube.taken)} steps, at the end every coordinate within {tube.radii[-1].max():.1e}")
print(f"no two agents came nearer than {nearest.lower:.4f}, between the steps included")

# %%
bounds = np.array(
    [[[float(x.lower()), float(x.upper())] for x in tube.distances_during(k)] for k in range(len(tube.taken))]
)
fig, ax = plots.subplots(size=(6, 3.8))
for (i, j), (low, high) in zip(tube.pairs, bounds.transpose(1, 2, 0), strict=True):
    ax.fill_between(tube.t, [*low, low[-1]], [*high, high[-1]], step="post", alpha=0.5, label=f"{i}, {j}: proved")
    ax.plot(numerical.t, np.linalg.norm(numerical.q[:, j] - numerical.q[:, i], axis=1), "k:", linewidth=1.0)
ax.axhline(law.alpha.r, color="grey", linewidth=0.8)
ax.annotate("r: a link forms", (0.0, law.alpha.r), va="bottom", fontsize=8)
ax.set(xlabel="time", ylabel="distance of a pair (length)")
_ = ax.legend(loc="upper right")

# %% [markdown]
# **Figure 13.3.** The steps of the bands are the steps of the proof: each box holds the distance of a pair at *all*
# times of its step. The dotted lines are the computed run. (The law enclosed has one tenth where the simulation has
# the binary number next to 0.1.)
#
# And the end of the tube, all of it, lies in the basin. So all of Theorem 3, its limit included, is proved for this
# start:

# %%
print("in the basin:", tube.ends_in(basin))
verdict = fl.verify("os-3", tube, basin=basin)
print(verdict.status, verdict.rigour, {claim.name: claim.status for claim in verdict.claims})

# %% tags=["facts"]
assert tube.ends_in(basin)
assert 0.05 < basin.share < 0.07
assert verdict.claim("ii").status == verdict.claim("iii").status == "verified"
assert not basin.holds(run.q[0], run.p[0])
assert any(basin.holds(q, p) for q, p in zip(run.q, run.p, strict=True))
side, moved = fl.min_distance(rest.q), np.sqrt(2.0) * float(basin.radius)
assert f"{side:.3f} {side - moved:.3f} {side + moved:.3f}" == "6.989 6.403 7.574"
assert abs(float(basin.distance) - (side - moved)) < 2e-3
assert f"{np.log(1e3 * float(basin.overshoot)) / (2.0 * float(basin.rate)):.0f}" == "31"
at_first = float(basin.above(run.q[0], run.p[0])[1])
fallen = next(t for t, q, p in zip(run.t, run.q, run.p, strict=True) if float(basin.above(q, p)[1]) < 1e-3 * at_first)
assert 0.8 < fallen < 1.0


def force(y):
    return 30.0 * float(law.alpha.phi_alpha(law.alpha.sigma_norm(y))) * y / np.sqrt(1.0 + 0.1 * y * y)


assert f"{force(6.9) / 6.9:.1f} {(force(7.0 + 1e-6) - force(7.0 - 1e-6)) / 2e-6:.0f}" == "-3.5 223"

# %% [markdown]
# Compare with lecture 00, where the same words stood beside a *numeric* run. The word `interval` is the difference:
# nothing here rests on the integrator.
#
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
# It breaks while pairs lie about a switching distance. There the pair law is only once differentiable, so Taylor's
# formula has one term fewer, and the step adds more to the box the longer it lasts. The wider the box, the longer
# some state in it is about the switch, and the wider it leaves: a vicious circle. From one start (`radius=0`) the
# box is as narrow as rounding when the first links form, each crossing is short, and the tube reaches the end of the
# same time span. A proof by enclosure is easy for one motion and hard for many; a proof by energy, as the basin's,
# is the reverse.
#
# ## What others find
#
# The certified radius is a lower bound of the true basin's. Samples show how far from the truth it may be, and prove
# nothing:

# %%
sampled = fl.sample_basin(basin, np.linspace(0.03, 0.9, 7) * 7.0, runs=8, t_end=10.0)
_ = plots.sampled_basin(sampled)

# %% tags=["facts"]
assert (sampled.shares[sampled.distances < 0.62 * 7.0] == 1.0).all()

# %% [markdown]
# **Figure 13.4.** Share of random starts at a distance from the orbit that return to it, with intervals of
# confidence; the vertical line is the certified radius.
#
# ## A certificate
#
# Why should anyone believe a program that says "proved"? Because it leaves a *certificate*: exact parameters,
# positions in hexadecimal, the bounds of the pairs. `flockana check FILE`, or `fl.check_certificate`, verifies it
# with code of its own, which shares only the scalar functions with the code that proved. To find a proof is hard and
# may use any trick; to check it is easy, and it is the check that one has to trust.

# %%
file = Path(tempfile.mkdtemp()) / "triangle.json"
fl.write_certificate(basin, file)
checked = fl.check_certificate(file)
print(*checked.steps, sep="\n")
of_run = file.with_name("run.json")
fl.write_tube_certificate(tube, of_run, basin=basin)
of_tube = [step for step in fl.check_certificate(of_run).steps if not step.startswith("basin: ")]
print(*of_tube, sep="\n")

# %% [markdown]
# ## Questions that come up
#
# *Does the basin hold for a triangle that is turned, or elsewhere, or that follows a moving γ-agent?* Turned: yes, the
# distance is that from the whole orbit. Elsewhere and moving: yes, because by the split of lecture 03 the shape does
# not see where the centre is, nor the γ-agent. Only bounds on the agents' places would need the centre's filter.
#
# *Could a longer tube replace the basin?* No. A tube ends at a finite time, and convergence is a statement about all
# times. Nor can the basin replace the tube: it is small, and most starts are outside.
#
# *The tube of seven agents broke. Is that flock unstable?* Nothing is said about the flock. The *bounds* became
# useless. A method that proves is silent when it fails; it does not refute.
#
# *Why is the certified radius so small?* Each step gives something away. A bound takes the worst pair in the worst
# direction over the whole interval of lengths, although no displacement is the worst for all pairs at once, and the
# ball must fit where the basin is narrowest.
#
# *The measured start of real drones is not exact. What then?* Give the tube a box as its start. Then the statement
# holds for all starts in the box, and the question becomes how long a box of that size can be carried.
#
# ## What surprised, and what the theorems do not say
#
# To prove convergence for all time was easier than to prove the first second. The basin needs no solution, the tube
# no theory of stability. What is *not* proved: anything about starts outside the tube and the basin; anything about
# a law with other parameters, or with noise or delay; that the model is the drones. And the certified radius is 0.06
# $d$, while all samples up to 0.6 $d$ returned: a theorem that is true may still be timid.
#
# ## Summary
#
# - A lower bound of the curvature along rays from the orbit, and an energy that falls, certify a basin; its
#   certificate is checked by other code.
# - An inclusion $x + [0,\Delta t][f] \subset [y]$ encloses a step, and a chain of steps a run, so that a run becomes
#   a proof.
# - A certified radius is a lower bound; samples show how far it may be from the truth.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★★ (2 points, derivation) Two agents under Algorithm 1, 7 apart. A displacement by $\xi$ over all
# coordinates stretches the link by $\sqrt2\,\xi$, and at $r = 8.4$ the link breaks. What is the largest $\xi_0/d$
# that any proof could reach? (Four significant digits.)

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
# **3.** ★★ (2 points, derivation) Along a ray the curvature of $U$ is at least
# $\underline S(\xi) = 3 - \tfrac32\xi$. (a) Compute $G(2)$, the energy above $U^*$ that a state must have to leave
# the ball of radius 2. (b) Up to which $\xi_0$ is $G' > 0$ on $(0, \xi_0)$, so that larger balls are excluded? (c)
# Which level does $G(\xi_0)$ tend to there? Give the list of the three numbers, exactly.

# %% tags=["answer"]
levels = ...

# %% tags=["solution"]
levels = [1.5 * 2.0**2 - 0.25 * 2.0**3, 4.0, 1.5 * 4.0**2 - 0.25 * 4.0**3]  # G' = 3ξ − ¾ξ² vanishes at 4

# %% tags=["check"]
grade(levels, [4.0, 4.0, 8.0], hint="integrate the bound twice, from 0; G rises as long as G' > 0")

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
# **5.** ★★★ (3 points, words) The tube ends in the basin. What is proved of this start that the run alone does not
# show, and what is still not proved? Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Proved is that the true solution, not only the computed one, enters the basin, hence converges to the triangle with
# matched velocities and never collides, for all time. Not proved is anything about other starts outside the tube and
# the basin, or about a law with other parameters.
#
# **Rubric, a point each:** the true solution is enclosed, not only computed; from the basin convergence follows for
# all time, without collisions; other starts and parameters remain open.

# %% [markdown] tags=["exercise"]
# **6.** ★ (1 point, player) Play the run of three agents. By how many degrees is the triangle that it ends in turned
# against the equilibrium `rest`, counterclockwise? Take the angle of agent 0 as seen from the centre. (Two significant
# digits.)

# %% tags=["answer"]
turned = ...

# %% tags=["solution"]
angles = [np.arctan2(*(q[0] - q.mean(axis=0))[::-1]) for q in (run.q[-1], rest.q)]
print(angles)
turned = np.degrees(angles[0] - angles[1])

# %% tags=["check"]
grade(turned, 9.02977, digits=2, hint="the orbit has many points; compare the angles at the end and of rest")

# %% [markdown] tags=["exercise"]
# **7.** ★★★ (3 points, proof) The scalar equation $\dot x = -x^3$ starts in $[x] = [0.9, 1]$. Prove with the
# enclosure theorem and $[y] = [0.5, 1.1]$ that all solutions stay in $[y]$ for a time $\Delta t$, and give a
# $\Delta t$ that works. Why can no single step with this $[y]$ reach $\Delta t = 1$, although the solutions do stay
# in $[y]$ up to $t = 1$?

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# On $[y]$ one has $[f] = [-1.331, -0.125]$. The set $x + [0,\Delta t][f]$ is $[x - 1.331\,\Delta t, x]$. It lies in
# the interior of $[y]$ for all $x \in [0.9, 1]$ exactly if $0.9 - 1.331\,\Delta t > 0.5$, that is
# $\Delta t < 0.3005$, and $x \le 1 < 1.1$ holds; so $\Delta t = 0.3$ works. The true solutions are
# $x(t) = x_0/\sqrt{1 + 2x_0^2t}$; from 0.9 at $t = 1$ this is $0.9/\sqrt{2.62} = 0.556 > 0.5$, so they stay in
# $[y]$. But the inclusion uses the *largest* speed anywhere in $[y]$, 1.331, during the whole step, while the
# solution slows down. Several short steps with smaller boxes reach $t = 1$.
#
# **Rubric, a point each:** the enclosure of $f$ on $[y]$ and a $\Delta t$ below 0.3005 with the inclusion verified;
# the exact solution or another proof that it stays in $[y]$; the reason, that the bound uses the extreme speed of
# the box.

# %% [markdown] tags=["exercise"]
# **8.** ★★★ (3 points, project) Open project, about two weeks: certify a flock of your choice, as large as you can.
# For which sizes, gains and lattices does `certify` find a basin, how does its radius shrink with $n$, and how far
# is it from sampled basins? Find out which pair's bound limits it, and propose an improvement. Hand in the
# certificates with a page that explains them.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# A good answer certifies several patches (3, 7, 19 agents), tabulates radius, level and rate, and compares with
# `sample_basin` at the same distances with intervals. It looks at the stress across compressed pairs and at links
# near the range as the limiting terms, and argues for an improvement, such as cutting the ball into shells or using
# the energy level instead of the ball.
#
# **Rubric, a point each:** certificates that `flockana check` accepts, in a table over $n$ or gains; a fair
# comparison with samples; the limiting bound named, with a reasoned improvement.
