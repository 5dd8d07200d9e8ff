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
# # Real machines: saturation, sampling, delay and noise
#
# **Aims.** Put the four limits of real machines into a law, one at a time; find by hand what each does to one agent;
# check it on a flock; know which theorems survive.
#
# ## A scene
#
# The simulation flocks, the theorem is verified, the drones are built. On the first evening they shake. Their motors
# give at most so much thrust; their computers act fifty times a second, not continuously; what they hear is a
# twentieth of a second old; and their sensors are noisy. None of that is in the double integrator. **How much of
# each does a flock bear, and which of our theorems still says something?** The answers are surprisingly simple for
# one agent, and it is the *pair*, again, that decides for the flock.
#
# ## One agent and its target
#
# All of this lecture's computations are about one agent on a line that follows a γ-agent at rest, or about the
# centre of mass of a flock, which obeys the same equation (lecture 03):
#
# $$\dot x = v, \qquad \dot v = u, \qquad u = -(c_1^\gamma x + c_2^\gamma v) .$$
#
# The distance of two linked agents obeys it too, near $d$, with the stiffness 447 and the friction 3.93 of lecture
# 06 in the place of $c_1^\gamma = 1.1$ and $c_2^\gamma = 2.10$. So every formula below can be read twice: once for
# the slow centre, and once for the fast pair.
#
# | | stiffness | friction | natural frequency | damping ratio |
# |---|---|---|---|---|
# | centre | 1.1 | 2.10 | 1.05 | 1 |
# | pair | 447 | 3.93 | 21.1 | 0.093 |
#
# ## Saturation
#
# A motor gives $|u| \le u_{\max}$. Let $\operatorname{sat}$ be the function that cuts a number off at
# $\pm u_{\max}$, and let $z = c_1^\gamma x + c_2^\gamma v$ be what the law asks for.
#
# > **Theorem (one agent).** With $u = -\operatorname{sat}(z)$ and positive gains every solution converges to
# > $x = v = 0$.
#
# *Proof.* Let $W = \int_0^z\operatorname{sat} + \tfrac12c_1^\gamma v^2$.
#
# $$\begin{aligned}
# \dot z &= c_1^\gamma v - c_2^\gamma\operatorname{sat}(z) && \dot x = v, \ \dot v = -\operatorname{sat}(z) \\
# \dot W &= \operatorname{sat}(z)\,\dot z + c_1^\gamma v\,\dot v && \text{chain rule} \\
# &= \operatorname{sat}(z)\bigl(c_1^\gamma v - c_2^\gamma\operatorname{sat}(z)\bigr) - c_1^\gamma
#   v\operatorname{sat}(z) && \text{insert} \\
# &= -c_2^\gamma\operatorname{sat}(z)^2 \le 0 . && \text{two terms cancel}
# \end{aligned}$$
#
# 1. $W \ge 0$, and $W$ grows without bound with $|z|$, at least linearly, and with $|v|$. So its level sets are
#    bounded, closed, and positively invariant: compact.
# 2. By LaSalle the solution approaches an invariant set with $\operatorname{sat}(z) = 0$, that is $z = 0$.
# 3. There $\dot v = 0$ and $0 = \dot z = c_1^\gamma v$. So $v = 0$, and $z = 0$ gives $x = 0$. $\square$
#
# <details><summary>Where this function comes from</summary>
#
# Where does this $W$ come from? Without a limit $\operatorname{sat}(z) = z$ and $W = \tfrac12z^2 + \tfrac12c_1^\gamma
# v^2$: the square of what the law asks for, and the kinetic energy. The integral is what is left of a square when a
# spring has a limit: it grows like a square near 0 and like a straight line far away. Such a $W$ is called a Lyapunov
# function of *Lur'e's* type, and it is the first thing to try when a linear law passes through a nonlinear element.
#
# </details>
#
# A single agent bears any saturation; it only takes longer, and overshoots. And the flock? Its proofs used that pair
# forces cancel in the sum and that the force is a gradient. Cut off at a limit, neither is true. *By hand:* three
# agents on a line, A left of B and C, which are in one place, where the force between them is 0 (lecture 01). B and C
# push A with 4 each, so A is asked for $-8$, B and C for $+4$ each, and the sum is 0. With the limit 5, A gets $-5$, B
# and C get $+4$, and the sum is $+3$. The centre accelerates, and nobody outside has pushed. An agent that is pushed by
# several neighbours is cut off, each of the neighbours is not, so action is no longer reaction.

# %%
import numpy as np

import flockana as fl
from flockana import lattice, plots, stability
from flockana.course import Prediction, grade

start = 0.93 * lattice.hexagonal_patch(1, 7.0)
start[0] += [0.5, 0.2]
still = np.zeros_like(start)
for limit in (None, 20.0, 5.0):
    law = fl.Algorithm1() if limit is None else fl.Saturated(fl.Algorithm1(), limit)
    run = fl.simulate(law, start, still, (0.0, 10.0))
    drift = np.linalg.norm(run.p[-1].mean(axis=0))
    print(
        f"limit {limit}: the centre ends with the speed {drift:.1e}; connectivity {run.metrics().connectivity[-1]:.2f}"
    )
alone, times = fl.Algorithm2(target=fl.StaticTarget((0.0,))), np.linspace(0.0, 80.0, 801)
weak = fl.simulate(fl.Saturated(alone, 0.2), [[10.0]], [[0.0]], (0.0, 80.0), t_eval=times)
free = fl.simulate(alone, [[10.0]], [[0.0]], (0.0, 80.0), t_eval=times)
figure, ax = plots.subplots(size=(6, 3.2))
ax.plot(free.t, free.q[:, 0, 0], label="no limit")
ax.plot(weak.t, weak.q[:, 0, 0], label="limit 0.2")
ax.set(xlabel="time", ylabel="distance from the target (length)", xlim=(0.0, 60.0))
_ = ax.legend()

# %% [markdown]
# **Figure 14.1.** One agent returns to its target, without a limit and with one of 0.2. With the limit it flies past,
# turns around twice, and arrives, as the theorem says.
#
# The printout shows the momentum theorem of lecture 02 breaking: a flock that starts at rest ends with a moving
# centre. Theorems 1 and 3 say nothing about saturated flocks.
#
# ## Sampling
#
# A computer reads the state every $\Delta t$ and holds $u$ until the next time. Between two samples $u$ is constant,
# so the motion is a parabola, and the state at the next sample is
#
# $$\begin{pmatrix} x \\ v \end{pmatrix} \mapsto
# \begin{pmatrix} 1 - \tfrac12c_1^\gamma\Delta t^2 & \Delta t - \tfrac12c_2^\gamma\Delta t^2 \\
# -c_1^\gamma\Delta t & 1 - c_2^\gamma\Delta t \end{pmatrix}\begin{pmatrix} x \\ v \end{pmatrix} .$$
#
# > **Theorem (sampling).** The sampled agent is stable exactly if
# > $\Delta t < \min\bigl(2/c_2^\gamma,\ 2c_2^\gamma/c_1^\gamma\bigr)$.
#
# *Proof.* Both eigenvalues of a real $2\times2$ matrix lie inside the unit circle exactly if $|\det| < 1$ and
# $|\operatorname{tr}| < 1 + \det$ (Jury). For the characteristic polynomial is $f(z) = z^2 - \operatorname{tr} z +
# \det$. If the roots are a conjugate pair, the square of their modulus is $\det$, and $f > 0$ on the whole real line,
# at $\pm1$ too, where $f(\pm1) = 1 \mp \operatorname{tr} + \det$. If they are real and $f(1) > 0$, $f(-1) > 0$, both
# lie in $(-1, 1)$ or both on the same side outside, and then their product exceeds 1. Now compute.
#
# 1. $\operatorname{tr} = 2 - c_2^\gamma\Delta t - \tfrac12c_1^\gamma\Delta t^2$.
# 2. $\det = (1 - \tfrac12c_1^\gamma\Delta t^2)(1 - c_2^\gamma\Delta t) + c_1^\gamma\Delta t(\Delta t -
#    \tfrac12c_2^\gamma\Delta t^2) = 1 - c_2^\gamma\Delta t + \tfrac12c_1^\gamma\Delta t^2$: the cubic terms cancel.
# 3. $1 + \det - \operatorname{tr} = c_1^\gamma\Delta t^2 > 0$: always.
# 4. $1 + \det + \operatorname{tr} = 4 - 2c_2^\gamma\Delta t > 0$ exactly if $\Delta t < 2/c_2^\gamma$.
# 5. $\det < 1$ exactly if $\tfrac12c_1^\gamma\Delta t^2 < c_2^\gamma\Delta t$, that is
#    $\Delta t < 2c_2^\gamma/c_1^\gamma$. And $\det > -1$ follows from 3 and 4, added: $2 + 2\det > 0$. $\square$
#
# The first bound is about friction that acts too long and turns the velocity around; the second about a spring that
# pumps energy, because it pulls on a position that is old. For the centre they are 0.953 and 3.81.

# %% tags=["predict"]
guess = ...
Prediction(
    "Below which period is the pair stable, with its stiffness 447 and friction 3.93?",
    guess,
    min(2.0 / 3.9275, 2.0 * 3.9275 / 446.6),
)

# %% [markdown]
# **The pair asks for a sample rate fifty times that of the centre.**
#
# <details><summary>By hand, beyond the bound</summary>
#
# *By hand, beyond the bound.* Sample the centre once in a time unit, $\Delta t = 1 > 0.953$. Then $\operatorname{tr} =
# 2 - 2.098 - 0.55 = -0.648$ and $\det = 1 - 2.098 + 0.55 = -0.548$, and $z^2 + 0.648z - 0.548 = 0$ has the roots
# $0.484$ and $-1.132$. The second one is outside the circle, and it is *negative*: in each sample the error changes its
# sign and grows by 13 %. That is how too much friction looks: the agent is braked for so long that it comes back,
# harder. Over forty samples the factor is 140. At $\Delta t = 0.9$ the roots are $0.519$ and $-0.852$: it still flips
# at each sample, and dies out. A spring that pumps looks different. For the pair at $\Delta t = 0.03$ the trace is
# $1.681$ and the determinant $1.083$, so the roots are complex, of modulus $\sqrt{1.083} = 1.041$: a swing that grows
# by 4 % in each sample. *Look at the log: an error that flips at each sample calls for less friction, a swing that
# grows for a softer spring, and both for a faster clock.*
#
# </details>
#
# Notice that *different* bounds decide. The centre is limited by its friction: it would bear a stiffer spring. The pair
# is limited by its spring: it would bear more friction. Only $c_2^\gamma\Delta t$ and $c_1^\gamma\Delta t^2$ enter,
# both without a unit, so one picture holds all agents and all periods:

# %%
figure, ax = plots.subplots(size=(6.5, 3.8))
across = np.linspace(0.0, 2.0, 100)
ax.fill_between(across, 0.0, 2.0 * across, color="0.88", label="stable")
for name, spring, brake, marker in (("centre", 1.1, 2.0976, "o"), ("pair", 446.6, 3.9275, "s")):
    periods = np.geomspace(1e-3, 1.2, 200)
    ax.plot(brake * periods, spring * periods**2, label=f"{name}, as its period grows")
    for period in (0.01, 0.03) if name == "pair" else (0.5, 0.9):
        ax.plot(brake * period, spring * period**2, marker, color="black", markersize=5)
        place = brake * period, spring * period**2
        ax.annotate(f"{period:g}", place, (6, 2), textcoords="offset points", fontsize=8)
ax.set(xlim=(0.0, 2.4), ylim=(0.0, 4.2), xlabel="friction times period", ylabel="stiffness times period squared")
_ = ax.legend(loc="upper left", bbox_to_anchor=(0.2, 1.0))

# %% [markdown]
# **Figure 14.2.** Where a sampled agent is stable (grey): friction times period below 2, and stiffness times the square
# of the period below twice that. The curves are those of the centre and of the pair, with some periods marked. The
# centre leaves the region through its right side, the pair through its upper side, at once.

# %%
one = fl.Algorithm2(target=fl.StaticTarget((0.0,)))
for period in (0.9, 1.0):
    held = fl.simulate(fl.Sampled(one, period), [[1.0]], [[0.0]], (0.0, 40.0), dt=period / 10.0)
    print(f"one agent, a sample every {period}: after 40 it is {abs(held.q[-1, 0, 0]):.1e} away")
pair_margin = stability.sampling_margin(fl.Algorithm1(), np.array([[0.0], [7.0]])).period
law = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
c1, c2 = law.gains.c1_gamma, law.gains.c2_gamma
rest = fl.find_equilibrium(law, lattice.hexagonal_patch(2, 7.0))
print(f"a pair is stable up to {pair_margin:.4f}, by hand {2.0 * 3.9277 / 446.6:.4f}")
print(f"a hexagon of nineteen up to {stability.sampling_margin(law, rest.q).period:.4f}")

# %% tags=["facts"]
assert abs(stability.sampling_margin(one, np.array([[0.0]])).period - min(2.0 / c2, 2.0 * c2 / c1)) < 1e-6
assert abs(pair_margin - 0.017587) < 1e-5
assert abs(held.q[-1, 0, 0]) > 1.0
assert abs(weak.q[-1, 0, 0]) < 1e-6
assert [f"{2.0 / c2:.3f}", f"{2.0 * c2 / c1:.2f}", f"{2.0 / 3.9277:.2f}"] == ["0.953", "3.81", "0.51"]
assert drift > 1e-3


def multipliers(spring, brake, period):
    trace, det = 2.0 - brake * period - 0.5 * spring * period**2, 1.0 - brake * period + 0.5 * spring * period**2
    return trace, det, np.roots([1.0, -trace, det])


trace, det, roots = multipliers(c1, c2, 1.0)
assert f"{trace:.3f} {det:.3f} {max(roots):.3f} {min(roots):.3f}" == "-0.648 -0.548 0.484 -1.132"
assert f"{min(roots) ** 40:.0f}" == "140"
assert [f"{each:.3f}" for each in sorted(multipliers(c1, c2, 0.9)[2])] == ["-0.852", "0.519"]
trace, det, roots = multipliers(446.6, 3.9275, 0.03)
assert f"{trace:.3f} {det:.3f} {abs(roots[0]):.3f}" == "1.681 1.083 1.041"

# %% [markdown]
# ## Delay
#
# What an agent hears is $\tau$ old. Lecture 06 derived the delay margin of one agent,
# $\omega^4 = (c_1^\gamma)^2 + (c_2^\gamma)^2\omega^2$ and $\omega\tau = \arctan(c_2^\gamma\omega/c_1^\gamma)$, and
# found that a flock bears far less. A sampled agent acts on a state that is between 0 and $\Delta t$ old, on average
# $\tfrac12\Delta t$: sampling is, roughly, a delay of half a period. Is that more than a rule of thumb? For small
# friction both margins can be found in a line:
#
# $$\begin{aligned}
# \Delta t^* &= 2c_2^\gamma/c_1^\gamma && \text{the second bound of the theorem} \\
# \omega\tau^* &= \arctan(c_2^\gamma\omega/c_1^\gamma) \approx c_2^\gamma\omega/c_1^\gamma, &&
#   \text{the arctangent of a small number} \\
# \tau^* &\approx c_2^\gamma/c_1^\gamma = \tfrac12\Delta t^* . && \text{exactly half}
# \end{aligned}$$
#
# For the pair $\omega \approx \sqrt{447} = 21.1$ and $\arctan(3.93\cdot21.1/447) = 0.184$ give $\tau^* \approx 0.0087$,
# against half of 0.0176. For a strongly damped agent the rule is only rough, as the table shows.

# %%
for spring, brake in ((446.6, 3.9275), (100.0, 3.9275), (25.0, 10.0), (1.1, 2.0976)):
    omega = np.sqrt((brake**2 + np.sqrt(brake**4 + 4.0 * spring**2)) / 2.0)
    late, period = np.arctan(brake * omega / spring) / omega, min(2.0 / brake, 2.0 * brake / spring)
    print(f"stiffness {spring:5.1f}, friction {brake:5.2f}: delay {late:.4f}, half a period {0.5 * period:.4f}")

# %% [markdown]
# ## A design, and how it fails
#
# The drones' radio is 50 ms late, and their computers sample every 20 ms: a total age of 60 ms. The default flock bears
# 12.8 ms. What now? *Design the pair.* Let it be critically damped, with the natural frequency $\omega_n$: stiffness
# $\omega_n^2$, friction $2\omega_n$. Put this into the delay margin: $\omega^2 = (2+\sqrt5)\,\omega_n^2$, so
# $\omega = 2.058\,\omega_n$ and $\tau^* = \arctan(2\cdot2.058)/(2.058\,\omega_n) = 0.647/\omega_n$. With
# $\omega_n = 5$ that is 0.129, twice the age: a comfortable margin. The pair of lecture 06 has the stiffness
# $14.89\,c_1^\alpha$ and the friction $0.3585\,c_2^\alpha$, so $c_1^\alpha = 25/14.89 = 1.68$ and
# $c_2^\alpha = 10/0.3585 = 27.9$. Build it:

# %%
target = fl.StaticTarget((0.0, 0.0))
designs = {"default": fl.Gains(), "the pair's design": fl.Gains(c1_alpha=1.68, c2_alpha=27.9)}
designs |= {f"friction {share}": fl.Gains(c1_alpha=1.68, c2_alpha=27.9 * share) for share in (0.5, 0.25)}
bears = {}
for name, gains in designs.items():
    flock = fl.Algorithm2(gains=gains, target=target)
    at_rest = fl.find_equilibrium(flock, lattice.hexagonal_patch(1, 7.0)).q
    bears[name] = stability.delay_margin(stability.delay_system(flock, at_rest)).delay
    period, off = stability.sampling_margin(flock, at_rest).period, lattice.strain(at_rest, 7.0, 8.4)
    print(f"{name:>17}: bears a delay of {bears[name]:.4f}, sampling every {period:.4f}; links off d by {off:.1%}")

# %% tags=["facts"]
assert [f"{bears[name]:.4f}" for name in designs] == ["0.0128", "0.0307", "0.0573", "0.0954"]
assert bears["the pair's design"] < 0.06 < bears["friction 0.25"]
soft = fl.linearise(fl.Algorithm1(gains=designs["the pair's design"]), [[0.0], [7.0]]).modes[0]
assert abs(soft.damping_ratio - 1.0) < 1e-3
hard = fl.linearise(fl.Algorithm1(), [[0.0], [7.0]]).modes[0].eigenvalue
assert abs(abs(hard) ** 2 / 30.0 - 14.89) < 0.005
assert abs(-2.0 * hard.real / (2.0 * np.sqrt(30.0)) - 0.3585) < 1e-4
critical = fl.Algorithm1(gains=designs["the pair's design"])
assert abs(stability.delay_margin(stability.delay_system(critical, [[0.0], [7.0]])).delay - 0.647 / 5.0) < 5e-4

# %% [markdown]
# The design fails: seven agents bear 31 ms, not 129. Why? An agent in a flock has up to six neighbours, and their
# frictions *add*: the fastest mode has several times the friction of a pair, and it is friction that acts late.
# Designed for less friction, a quarter of it, the flock bears 95 ms, though now its pairs are underdamped. And look at
# the last column: the soft links are squeezed by the pull of the γ-agent, by 3.9 % instead of 0.2 %.
#
# So "the pair decides" was a good rule for a stiff flock and a bad one for a soft flock. The right rule is: *look at
# all modes*. And the trade-off of lecture 06 is now in numbers: tight formations need fast radios, and what one gains
# in delay one pays in precision.
#
# ## Noise
#
# Let the motor be pushed by white noise of intensity $g$: beside $\dot v = u$, in a time $\Delta t$ the noise adds a
# random velocity of variance $g^2\Delta t$. The agent never comes to rest; how far does it wander? Take expectations
# $\langle\cdot\rangle$ of the products:
#
# $$\begin{aligned}
# \tfrac{d}{dt}\langle x^2\rangle &= 2\langle xv\rangle && \dot x = v \\
# \tfrac{d}{dt}\langle xv\rangle &= \langle v^2\rangle - c_1^\gamma\langle x^2\rangle - c_2^\gamma\langle
#   xv\rangle && \text{product rule} \\
# \tfrac{d}{dt}\langle v^2\rangle &= -2c_1^\gamma\langle xv\rangle - 2c_2^\gamma\langle v^2\rangle + g^2 . &&
#   \text{the noise adds } g^2\Delta t
# \end{aligned}$$
#
# <details><summary>Why the noise enters once</summary>
#
# (Why is there $g^2$ in the last line only? In a short time $\Delta t$ the velocity gets $v + \text{noise}$, and
# $\langle(v+\text{noise})^2\rangle = \langle v^2\rangle + 2\langle v\,\text{noise}\rangle + g^2\Delta t$; the middle
# term is 0, because the noise of the moment does not know the velocity. In $xv$ the noise appears once, so its mean is
# 0.)
#
# </details>
#
# In the long run all three are constant. The first gives $\langle xv\rangle = 0$, the third
# $\langle v^2\rangle = g^2/(2c_2^\gamma)$, the second
#
# $$\langle x^2\rangle = \frac{g^2}{2c_1^\gamma c_2^\gamma} .$$
#
# Noises of $n$ agents are independent, so their mean has the intensity $g/\sqrt n$, and **the centre of a flock
# wanders $\sqrt n$ times less than one agent alone would**. That is the oldest reason to fly in a flock.
#
# The formula has a moral for designers. The variance of the velocity does not depend on the spring, and that of the
# position depends on the *product* of spring and friction. In the long run a stiff, weakly damped agent is as still as
# a soft, strongly damped one. For the distance of a pair two independent noises count, so $g^2$ becomes $2g^2$: with
# $g = 0.5$ the variance is $2\cdot0.25/(2\cdot447\cdot3.93)$, a standard deviation of 0.012, or 0.17 %
# of $d$. Noise hardly shakes the links; it moves the whole.

# %%
noisy = fl.Disturbed(law, intensity=0.5, seed=0)
shaken = fl.simulate(noisy, lattice.hexagonal_patch(1, 7.0), np.zeros((7, 2)), (0.0, 60.0), dt=0.01)
wander = shaken.q.mean(axis=1)[1000:]
print(f"variance of the centre: {wander.var(axis=0).mean():.4f} measured, {0.25 / 7.0 / (2.0 * c1 * c2):.4f} predicted")
generator = np.random.default_rng(0)
x, v, step = np.zeros(4000), np.zeros(4000), 0.01
for _ in range(4000):  # four thousand single agents, by the simplest scheme
    x, v = x + step * v, v - step * (c1 * x + c2 * v) + 0.5 * np.sqrt(step) * generator.standard_normal(4000)
print(f"variance of one agent:  {x.var():.4f} measured, {0.25 / (2.0 * c1 * c2):.4f} predicted")
figure, ax = plots.subplots(size=(6, 3.2))
away = np.linalg.norm(shaken.q - shaken.q[0], axis=2)
ax.plot(shaken.t, away[:, 1:].mean(axis=1), linewidth=0.7, label="an outer agent of seven, on the average")
ax.plot(shaken.t, np.linalg.norm(shaken.q.mean(axis=1), axis=1), linewidth=1.4, label="their centre")
ax.set(xlabel="time", ylabel="distance from the start (length)")
_ = ax.legend()
shaken.player(height=420)

# %% tags=["facts"]
assert abs(x.var() / (0.25 / (2.0 * c1 * c2)) - 1.0) < 0.1
assert shaken.q[:, 1, 1].std() > wander.std(axis=0).max()
assert abs(np.sqrt(0.5 / (2.0 * 446.6 * 3.9275)) / 7.0 - 0.0017) < 1e-4
assert 0.3 < wander.var(axis=0).mean() / (0.25 / 7.0 / (2.0 * c1 * c2)) < 3.0

# %% [markdown]
# **Figure 14.3.** Seven agents pushed by independent noises. Thin: an outer one, which also turns with the hexagon;
# dashed: the centre, which stays closer to the target.
#
# Nothing holds the *orientation*: it is a zero mode (lecture 06), and noise makes it drift like a random walk. A
# picture of drones would slowly turn. That is a theorem about the law, and no fault of the motors.
#
# ## Which theorems survive?
#
# Go through the four limits once more, and ask of each what it does to the *proofs* of lectures 02 and 03. They use
# three facts: forces of a pair are opposite, the force is a gradient, friction takes energy out at every instant.
#
# | limit | opposite? | gradient? | takes energy out? | what is left |
# |---|---|---|---|---|
# | saturation | no | no | not always | one agent; nothing for a flock |
# | sampling | yes | yes, but held too long | no: it may pump | linear stability up to a period |
# | delay | yes | of an old state | no: it may pump | linear stability up to $\tau^*$ |
# | noise | yes | yes | on average only | variances near rest |
#
# Sampling by one common clock and one common delay keep momentum: what one agent gets the other loses, late or held. So
# the centre of a flock under Algorithm 1 still moves at constant velocity, exactly. It is the energy that goes. But
# read the small print. Agents that sample at different instants (`offsets=`) do not push each other equally. And a
# delay keeps momentum only if *everything* is late, an agent's own state too. If an agent knows itself at once and only
# its neighbours late, the two forces of a pair belong to different instants, they are not opposite, and the centre is
# pushed:

# %%
shaking = np.random.default_rng(0).normal(0.0, 0.5, start.shape)
machines = {"sampled": fl.Sampled(fl.Algorithm1(), 0.005)}
machines |= {f"late: {late}": fl.Delayed(fl.Algorithm1(), 0.004, late=late) for late in ("all", "neighbours")}
pushed = {}
for name, machine in machines.items():
    moving = fl.simulate(machine, start, shaking, (0.0, 1.0), dt=0.0005).p.mean(axis=1)
    pushed[name] = np.abs(moving - moving[0]).max()
    print(f"{name:>16}: the velocity of the centre changes by {pushed[name]:.1e}")

# %% tags=["facts"]
assert max(pushed["sampled"], pushed["late: all"]) < 1e-12
assert pushed["late: neighbours"] > 1e-4

# %% [markdown]
# Before you trust a theorem on a machine, find in its proof the line that the machine breaks. If there is none, the
# theorem holds; if there is one, you have learnt what to measure.
#
# ## What surprised, and what the theorems do not say
#
# A limit of thrust, which looks like the worst of the four, is harmless for one agent and breaks the oldest
# conservation law of a flock. The pair decides how fast a computer must be, though one looks at the centre; and a
# design for the pair alone fails where frictions add. Noise is averaged by numbers; delay and sampling are not. None of
# the four theorems is about a flock: they are about linear systems near rest, or about one agent. For the nonlinear
# flock with limits there are runs, verdicts that say *vacuous*, and open questions.
#
# ## Questions that come up
#
# *Why does friction, which calms things, make a late flock unstable?* It acts against a velocity that the agent no
# longer has. If that is long enough ago, it acts along the present velocity, and drives.
#
# *In which order should I put the four into a simulation?* One at a time, and each first for one agent, for which this
# lecture has the answer: a simulation that does not reproduce it has an error. Then each alone for the flock. Then two
# at a time, sampling and delay first, because their ages add up. A film with all four in it shows that something
# shakes, and never what.
#
# *Can one not undo a delay by prediction?* In part, if one knows the law and the neighbours obey it. Then the
# prediction's error takes the place of the delay.
#
# *Why does noise not add up for ever?* In the position of the centre it does not, because the γ-agent pulls it back. In
# the orientation, which nothing pulls back, it does.
#
# ## Summary
#
# - Saturated, one agent still converges (a Lyapunov function with an integral); a saturated flock loses momentum
#   conservation.
# - Sampled, an agent is stable for $\Delta t < \min(2/c_2^\gamma, 2c_2^\gamma/c_1^\gamma)$; the stiff pairs set the
#   rate.
# - Late by half a period and sampled are about the same, exactly so for small friction.
# - A flock's margins are those of its worst mode; frictions of neighbours add.
# - Noise of intensity $g$ leaves a variance $g^2/(2c_1^\gamma c_2^\gamma)$, divided by $n$ for the centre.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★★ (2 points, derivation) One agent has $c_1^\gamma = 4$, $c_2^\gamma = 1$. (a) Up to which period is it
# stable when sampled? (b) Which of the two bounds is it? Answer with its number, 1 for $2/c_2^\gamma$ and 2 for
# $2c_2^\gamma/c_1^\gamma$. (c) What variance does its position have under noise of intensity 2? Give the list,
# exactly.

# %% tags=["answer"]
limits = ...

# %% tags=["solution"]
limits = [0.5, 2, 0.5]  # 2 · 1/4; 4/(2 · 4 · 1)

# %% tags=["check"]
grade(limits, [0.5, 2, 0.5], hint="both formulas are in the summary")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, design) Let $c_1^\gamma = 1$. Which $c_2^\gamma$ makes the largest stable sampling period as
# large as possible? (Exactly.)

# %% tags=["answer"]
friction = ...

# %% tags=["solution"]
friction = 1.0  # 2/c2γ falls and 2 c2γ rises: they meet at 1

# %% tags=["check"]
grade(friction, 1.0, hint="one bound falls with c2γ, the other rises")

# %% [markdown] tags=["exercise"]
# **3.** ★★ (2 points, experiment) What is the sampling margin of the rhombus of four agents under Algorithm 1,
# `lattice.hexagonal_spiral(4, 7.0)` with its default gains? (`stability.sampling_margin(law, q).period`, three
# significant digits.)

# %% tags=["answer"]
rhombus_period = ...

# %% tags=["solution"]
rhombus_period = stability.sampling_margin(fl.Algorithm1(), lattice.hexagonal_spiral(4, 7.0)).period
print(rhombus_period)

# %% tags=["check"]
grade(rhombus_period, 0.0207228, digits=3, hint="fl.Algorithm1() and the positions are all it needs")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, counterexample) Counterexample hunt: "A sampled agent is the safer, the more friction it has."
# Give gains $[c_1^\gamma, c_2^\gamma, c']$ with $0 < c_2^\gamma < c'$ such that sampled every 0.5 the agent is
# stable with $c_2^\gamma$ and unstable with $c'$.

# %% tags=["answer"]
braked = ...

# %% tags=["solution"]
braked = [1.0, 1.0, 5.0]  # 2/5 < 0.5

# %% tags=["check"]
grade(
    braked,
    lambda g: (
        len(g) == 3
        and g[0] > 0.0
        and 0.0 < g[1] < g[2]
        and min(2.0 / g[1], 2.0 * g[1] / g[0]) > 0.5 > min(2.0 / g[2], 2.0 * g[2] / g[0])
    ),
    form="list",
    hint="which bound falls when friction grows?",
)

# %% [markdown] tags=["exercise"]
# **5.** ★ (1 point, player) Play the flock that is shaken. Through how many degrees does the hexagon turn, from its
# least to its largest angle? Give it to within 1 degree.

# %% tags=["answer"]
turned = ...

# %% tags=["solution"]
arm = shaken.q[:, 1] - shaken.q.mean(axis=1)
turned = np.degrees(np.ptp(np.unwrap(np.arctan2(arm[:, 1], arm[:, 0]))))
print(turned)

# %% tags=["check"]
grade(turned, 4.348, within=1.0, hint="follow one outer agent")

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) A colleague damps the shaking of a sampled formation by raising $c_2^\alpha$, and it
# gets worse. Explain, and say what else could be done. Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Friction that is held for a whole period acts on an old velocity. If the friction rate of a mode times the period
# exceeds 2, the velocity is turned around and grows from sample to sample; raising the gain crosses this bound.
# Sampling faster helps, and so does a softer link, that is a smaller $c_1^\alpha$, which allows less friction, or
# damping by what an agent measures of its own velocity at a higher rate.
#
# **Rubric, a point each:** the bound $2/c_2$ and why friction overshoots; a remedy that does not raise the gain.

# %% [markdown] tags=["exercise"]
# **7.** ★★★ (3 points, proof) Prove the theorem on saturation for any odd, continuous, non-decreasing function in
# place of $\operatorname{sat}$ that vanishes only at 0 and whose integral grows without bound. Where would the proof
# fail for a function with a dead zone about 0?

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# The computation of $\dot W$ uses only the chain rule: $\dot W = -c_2^\gamma f(z)^2$ for the function $f$. Its
# integral is non-negative because $f$ has the sign of its argument, and unbounded by hypothesis, so level sets of
# $W$ are compact. $f(z) = 0$ only at $z = 0$, and the last step is as before. With a dead zone $f(z) = 0$ holds for
# all small $z$; the invariant set then contains every state at rest with $|z|$ in the dead zone: with $v = 0$ and
# $\dot v = 0$ nothing moves. The agent stops near the target and not at it; it still cannot drift for ever, because
# with $v \ne 0$ constant $z$ leaves the zone.
#
# **Rubric, a point each:** the rate of $W$ for a general function; compactness and the invariant set; the dead
# zone's set of rest positions.
