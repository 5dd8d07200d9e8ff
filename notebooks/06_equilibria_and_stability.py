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
# # Equilibria and linearised stability
#
# **Aims.** Find the equilibrium that a flock settles in and say of which kind it is; linearise about it and prove
# which poles it has; check the linear model against the nonlinear law; read modes, delay margin and the value of a
# gain off it.
#
# ## A scene
#
# The drones hover in formation when a gust hits the show. For some seconds the picture wobbles, like jelly, then it
# stands again. The next evening the radio is congested, messages come a twentieth of a second late, and the same
# gust makes the picture shake itself to pieces. **How fast does a formation calm down, in which shapes does it
# wobble, and how much delay does it bear?** These are questions about small disturbances of a state at rest, and for
# them control engineering has its sharpest tool: the linear system.
#
# ## Two agents
#
# Two agents under Algorithm 1 rest at the distance $d$. Let $y$ be their distance. From lecture 02,
#
# $$\ddot y = -2c_1^\alpha\,\phi_\alpha(\|y\|_\sigma)\,\frac{y}{\sqrt{1+\varepsilon y^2}} -
#   2c_2^\alpha\,a_{12}\,\dot y .$$
#
# Put $y = d + \tilde x$ with $\tilde x$ small. As $\phi_\alpha(d_\alpha) = 0$, only the derivative of $\phi_\alpha$
# counts in the first term, and the inner derivative of $\|y\|_\sigma$ is $y/\sqrt{1+\varepsilon y^2}$ once more:
#
# $$\ddot{\tilde x} + 2c_2^\alpha\,a_{12}(d)\,\dot{\tilde x} +
#   2c_1^\alpha\,\phi_\alpha'(d_\alpha)\,\frac{d^2}{1+\varepsilon d^2}\,\tilde x = 0 .$$
#
# Compare with $\ddot{\tilde x} + 2\zeta\omega_n\dot{\tilde x} + \omega_n^2\tilde x = 0$. With the numbers of lecture
# 01, $\phi_\alpha'(d_\alpha) = 0.896$, $a_{12}(d) = 0.179$, and the gains $c_1^\alpha = 30$, $c_2^\alpha = 2\sqrt{30} =
# 10.95$, one has $\omega_n^2 = 2\cdot30\cdot0.896\cdot49/5.9 = 447$ and $2\zeta\omega_n = 2\cdot10.95\cdot0.179 =
# 3.93$, so $\omega_n = 21.1$ and $\zeta = 3.93/42.3 = 0.093$: a stiff spring, weakly damped. A swing loses the factor
# $e$ in $2/3.93 = 0.51$ time units, and in this time goes to and fro $21.1\cdot0.51/2\pi = 1.7$ times. The gain
# $2\sqrt{30}$ looks as if somebody had aimed at critical damping; but the bump has cut the friction to 18 %, and the
# factor $d^2/(1+\varepsilon d^2) = 8.3$ has raised the stiffness. One does not see that in the law. One sees it in the
# linearisation.
#
# ## The linearised flock
#
# In the frame of the centre of mass Algorithm 2 is (lecture 03) $\dot x = v$,
# $\dot v = -\nabla U_\lambda(x) - (c_2^\gamma I + c_2^\alpha \hat L(x))v$ with
# $U_\lambda = c_1^\alpha V + \lambda J$, $\lambda = c_1^\gamma$. A state at rest is an equilibrium exactly if
# $\nabla U_\lambda(x^*) = 0$. Let $x = x^* + \tilde x$, with $\tilde x$ and $v = \dot{\tilde x}$ small, and keep
# what is linear in them:
#
# 1. $\nabla U_\lambda(x^* + \tilde x) = \nabla U_\lambda(x^*) + S\tilde x + \dots = S\tilde x + \dots$ with
#    $S = \nabla^2U_\lambda(x^*)$.
# 2. $\hat L(x)v = \hat L(x^*)v + \dots$: the change of $\hat L$ is of first order, and $v$ is too, so their product
#    is of second order.
#
# $$\ddot{\tilde x} + \underbrace{(c_2^\gamma I + c_2^\alpha \hat L(x^*))}_{D}\,\dot{\tilde x} +
#   \underbrace{\nabla^2 U_\lambda(x^*)}_{S}\,\tilde x = 0, \qquad (s^2 I + s D + S)\,\nu = 0 .$$
#
# $D$ is the damping, $S$ the stiffness, both symmetric; $s$ is a pole and $\nu$ its mode.
#
# The eigenvalues of $S$ say of which kind the equilibrium is. All positive: a *minimum*. One negative: a *saddle*
# (or a maximum, if all are). Zeros: *degenerate*, and one has to find out why.

# %%
import numpy as np

import flockana as fl
from flockana import lattice, plots, stability
from flockana.course import Prediction, figures, grade
from flockana.lattice.rigidity import rigidity_matrix
from flockana.stability.zero_modes import complement

figure, axes = plots.subplots(1, 3, size=(12, 3.9))
_ = figures.equilibria(axes=axes)

# %% [markdown]
# **Figure 6.1.** Level curves of three potentials, an equilibrium (star), and two strongly damped motions (from
# circles). At a minimum both arrive, at a saddle almost none, in a degenerate valley each arrives at a point of its
# own.
#
# **Zeros that must be.** Turn the whole flock about its centre by the angle $\theta$, $x \mapsto Q(\theta)x$. No
# distance changes, so $U_\lambda(Q(\theta)x) = U_\lambda(x)$, and $\nabla U_\lambda(Q(\theta)x^*) = 0$ for all
# $\theta$. Differentiate at $\theta = 0$: $S\,Q'(0)x^* = 0$. So the rotation $Q'(0)x^*$ is a zero mode of $S$ at
# *every* equilibrium. (Translations are none here, because the γ-agent holds the centre; under Algorithm 1 they
# are.) Zero modes that come from a symmetry are harmless, and all others are news.
#
# > **Theorem (poles).** Let $D$ be positive definite and $S$ positive semidefinite. Then every pole has
# > $\operatorname{Re} s < 0$ or is 0; the pole 0 has the multiplicity of the kernel of $S$, and no solution grows.
# > If $S$ has a negative eigenvalue, there is a real pole $s > 0$.
#
# *Proof.*
#
# 1. Let $(s^2I + sD + S)\nu = 0$ with $\|\nu\| = 1$. Multiply by $\nu^*$: $s^2 + 2\zeta' s + \omega'^2 = 0$ with the
#    numbers $2\zeta' = \nu^*D\nu > 0$ and $\omega'^2 = \nu^*S\nu \ge 0$.
# 2. If $\omega'^2 > 0$, all coefficients are positive, and both roots of a quadratic with positive coefficients have
#    negative real part. If $\omega'^2 = 0$, the roots are 0 and $-2\zeta'$.
# 3. So a pole that is not in the open left half-plane is 0, and $S\nu = 0$.
# 4. The pole 0 makes no term that grows like $t$: that would be a solution $\tilde x = \nu_1 + t\nu_0$ with
#    $S\nu_0 = 0$ and $D\nu_0 + S\nu_1 = 0$. Multiply by $\nu_0^\top$:
#    $\nu_0^\top D\nu_0 = -\nu_0^\top S\nu_1 = -(S\nu_0)^\top\nu_1 = 0$, against $D > 0$.
# 5. The last sentence is the lemma of lecture 03. $\square$
#
# For Algorithm 2 with $c_2^\gamma > 0$ the matrix $D$ is positive definite, as $\hat L$ is positive semidefinite.
# **So at a minimum a linearised flock of Algorithm 2 always calms down**; the question is how fast.
#
# ## A hexagon of nineteen

# %%
law = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
rest = fl.find_equilibrium(law, lattice.hexagonal_patch(2, 7.0))
print(f"{rest.kind}, residual {rest.residual:.1e} of the force scale")
print(f"its links are off d by {lattice.strain(rest.q, 7.0, 8.4):.1%} at most")
L = fl.linearise(law, rest)
print("zero modes:", [mode.name for mode in L.zero_modes], " semisimple:", L.semisimple)
print(f"slowest decay rate {L.decay_rate:.4f}; of the structure alone {L.structural_decay_rate:.4f}")
for mode in L.modes[:7]:
    print(plots.mode_title(mode))
_ = plots.pole_map(L.eigenvalues)

# %% [markdown]
# **Figure 6.2.** The poles of nineteen agents. All lie in the open left half-plane but one, at 0: the rotation.
#
# <details><summary>How to read the output</summary>
#
# How to read the output. The *residual* is the largest force that is left, relative to the forces of the law: 0 up
# to rounding. A zero mode is *semisimple* if it makes no term that grows like $t$ (step 4 of the proof). The decay rate
# is $-\operatorname{Re}s$ of the slowest pole, zero modes apart; that *of the structure* leaves out the motion of the
# centre.
#
# </details>
#
# `find_equilibrium` minimises $U_\lambda$. The hexagon is a minimum, a little smaller than the lattice: the γ-agent
# compresses it. It is *semi-stable*: the shape converges, and the flock ends somewhere on a circle of equilibria.
# The four slowest modes are the centre of mass, critically damped by our choice $c_2^\gamma = 2\sqrt{c_1^\gamma}$,
# so at the rate $\sqrt{1.1} = 1.049$. Then the structure begins:

# %%
shapes = L.structural_modes[:3]
figure, axes = plots.subplots(1, 3, size=(13, 4.2))
pairs = lattice.links(rest.q, law.alpha.r)
for ax, mode in zip(axes, shapes, strict=True):
    plots.mode_shape(rest.q, pairs, mode.shape, ax=ax, title=plots.mode_title(mode))
stability.mode_motion(L, shapes[0]).player(height=520)

# %% [markdown]
# **Figure 6.3.** The three slowest structural modes. The slowest is *breathing*: all agents move outwards together
# and back. The player shows it in motion, much enlarged.
#
# <details><summary>What the shapes mean</summary>
#
# What do the shapes mean? A flock of $n$ agents in the plane has $2n$ coordinates, so $2n$ modes: 2 translations, 1
# rotation, and $2n - 3$ shapes. For nineteen agents that is 35 shapes. A *breathing* mode changes all distances by
# the same share. *Shear* modes come in pairs, because the hexagon looks the same after a turn by 60°: two shapes
# with the same pole, of which one is the other one turned. (Modes 6 and 7 of the figure are such a pair.) If you see
# two equal poles, look for a symmetry. If you see three, look again.
#
# Which modes are slow? A mode is stiff if it changes the lengths of many links, and soft if it changes few.
# Breathing changes all of them, and yet it is among the slowest to decay here, because decay is not stiffness: an
# underdamped mode decays at the rate $\zeta'$ of the proof, half of its friction, whatever its stiffness. Friction
# between neighbours acts on *differences* of velocities, and in breathing neighbours move nearly alike. The fastest
# modes are those in which neighbours move against each other. That is the same fact as in lecture 00a: the Laplacian
# is small on smooth vectors and large on rough ones.
#
# </details>
#
# ## Does it tell the truth?
#
# A linear model is a claim about small disturbances. Test it: push the flock along its slowest structural mode by
# $10^{-4}$ and let the *nonlinear* law act. The mismatch $\tilde K = \tfrac1{2n}\sum\|v_i\|^2$ is quadratic in the
# velocities, so it must fall at twice the mode's decay rate. Sample finely enough to see its peaks: a fit through
# coarse peaks is off in the third digit.

# %%
slow = shapes[0]
push = 1e-4 * slow.shape.real
times = np.linspace(0.0, 4.0, 4001)
run = fl.simulate(law, rest.q + push, np.zeros_like(push), (0.0, 4.0), rtol=1e-12, atol=1e-14, t_eval=times)
K = run.metrics()["normalised_velocity_mismatch"].values
peaks = [k for k in range(1, len(K) - 1) if K[k - 1] < K[k] > K[k + 1] and run.t[k] > 0.2]
measured = -0.5 * np.polyfit(run.t[peaks], np.log(K[peaks]), 1)[0]
print(f"predicted {slow.decay_rate:.4f}, measured {measured:.4f}")

# %% [markdown]
# ## Delay
#
# Let everything that an agent hears be late by $\tau$. The linear equation becomes
# $\ddot{\tilde x}(t) + D\dot{\tilde x}(t-\tau) + S\tilde x(t-\tau) = 0$, and a solution $e^{st}\nu$ needs
#
# $$\det\bigl(s^2 I + (sD + S)e^{-s\tau}\bigr) = 0 ,$$
#
# which has infinitely many roots. For small $\tau$ all are on the left; as $\tau$ grows, a pair reaches the
# imaginary axis at some $\tau^*$, the *delay margin*. For a single agent on a γ-agent it can be found by hand. At
# the margin $s = i\omega$, so $\omega^2 = (i\omega c_2^\gamma + c_1^\gamma)e^{-i\omega\tau}$:
#
# $$\begin{aligned}
# \omega^4 &= (c_1^\gamma)^2 + (c_2^\gamma)^2\omega^2 && \text{compare moduli: this gives } \omega \\
# \omega\tau &= \arctan\bigl(c_2^\gamma\omega/c_1^\gamma\bigr) && \text{compare phases: this gives } \tau
# \end{aligned}$$
#
# With $c_1^\gamma = 1.1$ and $c_2^\gamma = 2\sqrt{1.1}$ the first line reads $\omega^4 = 1.21 + 4.4\,\omega^2$, so
# $\omega^2 = \tfrac12(4.4 + \sqrt{19.36 + 4.84}) = 4.66$ and $\omega = 2.159$; the second gives
# $\omega\tau = \arctan4.116 = 1.332$ and $\tau^* = 0.617$.
#
# For a flock, a Chebyshev discretisation finds the rightmost roots.

# %%
margin = L.delay_margin()

# %% tags=["predict"]
guess = ...
Prediction("The centre bears a delay of 0.617. How much does the flock of nineteen bear?", guess, float(margin.delay))

# %%
print(margin)
for share in (0.9, 1.1):
    root = fl.linearise(fl.Delayed(law, share * margin.delay), rest).rightmost(1)[0]
    print(f"at {share:.1f} of the margin the rightmost root is {root:.3f}")
w = np.sqrt((law.gains.c2_gamma**2 + np.sqrt(law.gains.c2_gamma**4 + 4.0 * law.gains.c1_gamma**2)) / 2.0)
alone = np.arctan(law.gains.c2_gamma * w / law.gains.c1_gamma) / w
print(f"the centre of mass alone would bear {alone:.4f}")

# %% [markdown]
# The flock bears far less delay than its centre: 0.0127 against 0.617. If the time unit is a second, the twentieth of a
# second of our scene is four times too much, and the picture shakes itself to pieces. Stiff links are fast oscillators,
# and a fast oscillator tolerates little delay: its phase margin is used up at $\omega\tau$ of a fraction of a radian.
#
# A delay margin computed by a discretisation deserves a check of its own. For the single agent the equation is short
# enough to integrate by hand: remember the past, and step.


# %%
def late(tau, dt=1e-3, end=60.0):
    """Largest swing of the last quarter over that of the first, of x'' = -c1 x(t - tau) - c2 x'(t - tau)."""
    c1, c2, wait, x, v = 1.1, 2.0 * np.sqrt(1.1), round(tau / dt), [1.0], [0.0]
    for k in range(round(end / dt)):
        past = max(k - wait, 0)
        push = -c1 * x[past] - c2 * v[past]
        v.append(v[-1] + dt * push)
        x.append(x[-1] + dt * v[-1])
    quarter = len(x) // 4
    return max(map(abs, x[-quarter:])) / max(map(abs, x[:quarter]))


for share in (0.9, 1.0, 1.1):
    print(f"at {share:.1f} of the margin of one agent the swing changes by the factor {late(share * alone):.3f}")

# %% tags=["facts"]
assert late(0.9 * alone) < 0.2
assert late(1.1 * alone) > 5.0

# %% [markdown]
# Below the margin the swing dies out, above it grows. The three numbers say more than the formula: at 0.9 of the
# margin the agent is *stable*, and its swing takes many periods to die. A margin is a cliff, not a target; a
# designer stays well away from it.
#
# <details><summary>Why the flock is so much more sensitive</summary>
#
# Why is the flock so much more sensitive than its centre? Look at the poles of Figure 6.2. The centre's are at
# $-1.05$; the structure's reach out to imaginary parts above 30. For a mode with stiffness $\omega'^2$ and little
# damping the phase of $sD + S$ is nearly 0, so the delay alone turns the force against the velocity: at
# $\omega'\tau$ of the order of the damping ratio the mode is no longer damped. The stiffest links decide, and they
# are the ones that a designer makes stiff in order to keep the pattern tight. So there is a trade-off that no gain
# removes: *tight formations need fast radios*.
#
# </details>
#
# ## Sampled and noisy
#
# A drone's computer reads the state every $\Delta t$ and holds its input until the next time. What is late by $\tau$
# is held here: on average the input is $\tfrac12\Delta t$ old. So a guess is that the flock bears a period of twice its
# delay margin. The linear model says more than a guess.
#
# Between two samples $u$ is constant and each agent moves on a parabola. With $u = -S\tilde x - D\tilde v$ the state
# at the next sample is
#
# $$\tilde x^+ = \tilde x + \Delta t\,\tilde v + \tfrac12\Delta t^2u, \qquad \tilde v^+ = \tilde v + \Delta t u .$$
#
# This is a *map*, and a map is stable if all its eigenvalues, the *multipliers* $z$, lie inside the unit circle:
# after $k$ samples a mode has the size $|z|^k$. Suppose first that $S$ and $D$ have their modes in common, and let one
# of them have the stiffness $\omega'^2$ and the damping $d'$. Then $z = 1 + \Delta t s$, where
#
# $$s^2 + \bigl(d' + \tfrac12\Delta t\,\omega'^2\bigr)s + \omega'^2 = 0 .$$
#
# *Derivation.* Call the multiplier $z = 1 + \Delta t s$ and look for $\tilde x_k = z^k\nu$.
#
# 1. The second equation gives $s\tilde v = u$, the first $s\tilde x = \tilde v + \tfrac12\Delta t u$.
# 2. Multiply the first by $s$: $s^2\tilde x = u + \tfrac12\Delta t su$.
# 3. $u = -\omega'^2\tilde x - d'\tilde v$, and by 1 again $\tilde v = s\tilde x - \tfrac12\Delta t u$. Put this
#    into $u$: $u\,(1 - \tfrac12\Delta t d') = -(\omega'^2 + d's)\tilde x$.
# 4. With 2: $s^2(1 - \tfrac12\Delta t d') = -(1 + \tfrac12\Delta t s)(\omega'^2 + d's)$. The terms
#    $\tfrac12\Delta t d's^2$ cancel, and the equation above is left.
#
# It is the equation of a flow whose damping has *grown*, by $\tfrac12\Delta t\,\omega'^2$, and yet sampling
# destabilises. For the circle is not the half-plane: $|z|^2$ is the product of the two roots, $1 - \Delta t d' +
# \tfrac12\Delta t^2\omega'^2$, so a mode that swings, whose two $z$ are conjugate, decays exactly if $\Delta t <
# 2d'/\omega'^2$. A mode that does not swing has two real $z$, and the danger is that one of them passes $-1$, so that
# the mode changes its sign at every sample. Put $z = -1$, that is $s = -2/\Delta t$, into the equation: $4/\Delta t^2 -
# 2d'/\Delta t - \omega'^2 + \omega'^2 = 0$, so $\Delta t = 2/d'$, whatever the stiffness. Together: *a mode decays
# exactly for $\Delta t < \min(2d'/\omega'^2,\ 2/d')$.* Take $\omega'^2 = 450$. With $d' = 4$ the first bound is 0.018
# and binds; with $d' = 40$ it is 0.18, but the second one is 0.05. The stiffer the mode and the weaker its damping, the
# shorter the period. For the whole flock, whose $S$ and $D$ do not commute, a computer finds the multipliers.

# %%
held = L.sampling_margin()
print(f"stable for periods below {held.period:.5f}, {held.period / margin.delay:.2f} times the delay margin")
print(f"the mode that goes first swings at {held.first.frequency:.1f} radians a time unit")
generator = np.random.default_rng(0)
for share in (0.95, 1.05):
    start = rest.q + 1e-4 * generator.standard_normal(rest.q.shape)
    run = fl.simulate(fl.TaylorStep(law, share * held.period), start, 0.0 * start, (0.0, 20.0))
    lengths = np.linalg.norm(run.q[:, rest.links[:, 0]] - run.q[:, rest.links[:, 1]], axis=2)
    swing = np.ptp(lengths[-200:], axis=0).max()
    print(f"at {share} of that period the lengths of links vary by {swing:.1e} in the end")

# %% [markdown]
# The guess was good: 2.13 times. And the nonlinear flock obeys: below the margin its links come to rest, above it they
# shake, by a few hundredths of a length here, because the bounded force of a link catches what the linear model lets
# grow for ever.
#
# Now the gust. Push every agent by white noise of intensity $g$: in a time $\Delta t$ it adds to each component of its
# velocity a random number of variance $g^2\Delta t$. A stable linear flock then neither rests nor grows. It reaches a
# *stationary covariance* $\Sigma$ of its state $y = (\tilde x, \tilde v)$: with $\dot y = Ay$ the covariance
# changes by
#
# $$\dot\Sigma = A\Sigma + \Sigma A^T + g^2\operatorname{diag}(0, I) ,$$
#
# the first two terms from the motion, the third from the noise, and in the long run $\dot\Sigma = 0$. This is a linear
# equation for $\Sigma$, *Lyapunov's*. For one mode it is solved by hand. Write $\langle\cdot\rangle$ for means:
#
# $$\begin{aligned}
# 0 = \tfrac{d}{dt}\langle\tilde x^2\rangle &= 2\langle\tilde x\tilde v\rangle && \langle\tilde x\tilde v\rangle = 0 \\
# 0 = \tfrac{d}{dt}\langle\tilde v^2\rangle &= -2\omega'^2\langle\tilde x\tilde v\rangle - 2d'\langle\tilde v^2\rangle
#   + g^2 && \langle\tilde v^2\rangle = g^2/(2d') \\
# 0 = \tfrac{d}{dt}\langle\tilde x\tilde v\rangle &= \langle\tilde v^2\rangle - \omega'^2\langle\tilde x^2\rangle -
#   d'\langle\tilde x\tilde v\rangle && \langle\tilde x^2\rangle = g^2/(2d'\omega'^2)
# \end{aligned}$$
#
# The square root of the trace of the block $\langle\tilde x\tilde x^T\rangle$ of $\Sigma$, for $g = 1$, is the
# *$H_2$ norm* from the forces to the shape. The other diagonal block counts the velocities, and is not part of it.
#
# One caution: the zero mode. Nothing brings the orientation back, so noise turns the flock like a random walk and its
# variance grows for ever. Lengths of links do not see this. So let the model predict how much each of the 42 links
# vibrates, and the nonlinear flock answer.

# %%
flow, g = stability.law_blocks(law, rest), 0.2
shape = stability.stationary_covariance(stability.disturbance_system(flow), g)
stretch = rigidity_matrix(rest.q, rest.links).toarray() @ complement(flow.rigid)
predicted = np.sqrt(np.diag(stretch @ shape @ stretch.T))
noisy = fl.simulate(
    fl.Disturbed(law, intensity=g, seed=1), rest.q, 0.0 * rest.q, (0.0, 100.0), dt=0.005, t_eval=np.arange(5, 100, 0.05)
)
lengths = np.linalg.norm(noisy.q[:, rest.links[:, 0]] - noisy.q[:, rest.links[:, 1]], axis=2)
shaken = lengths.std(axis=0)
print(f"predicted {predicted.min():.5f} to {predicted.max():.5f}, measured {shaken.min():.5f} to {shaken.max():.5f}")
figure, (left, right) = plots.subplots(1, 2, size=(8, 3.6))
turn = np.linspace(0.0, 2.0 * np.pi, 200)
left.plot(np.cos(turn), np.sin(turn), linewidth=0.8)
for share, mark in ((0.5, "o"), (1.1, "x")):
    z = fl.linearise(fl.TaylorStep(law, share * held.period), rest).multipliers
    left.plot(z.real, z.imag, mark, markersize=4, label=f"{share} of the margin")
left.set(xlabel="Re z", ylabel="Im z", aspect="equal", xlim=(0.2, 1.1), ylim=(-0.05, 1.05))
left.legend(loc="lower left")
right.plot(1e3 * predicted, 1e3 * shaken, "o", markersize=4)
right.axline((2.6, 2.6), slope=1.0, linewidth=0.8)
_ = right.set(xlabel="predicted (1e-3 length)", ylabel="measured (1e-3 length)")

# %% tags=["facts"]
assert abs(held.period - 0.02716) < 1e-5
assert abs(held.period / margin.delay - 2.13) < 0.01
assert swing > 1e-2
assert np.abs(shaken / predicted - 1.0).max() < 0.1

# %% [markdown]
# **Figure 6.4.** Left: multipliers of the sampled flock (those above the real axis), and the unit circle; at 1.1 times
# the margin a pair is outside. Right: how much each link vibrates in white noise, predicted by Lyapunov's equation and
# measured in a nonlinear run; on the line both agree.
#
# Every link vibrates within ten percent as predicted, the outer ones most: they have fewer neighbours that hold them.
# Both lessons point the same way. Sampling and delay are about the *stiffest* modes, noise is about the *softest and
# least damped* ones: a designer who stiffens links against noise pays with a faster computer, and friction between
# neighbours, $c_2^\alpha$, helps with both until it is itself too fast for the clock.
#
# ## What does a stronger damping buy?
#
# Raise $c_2^\gamma$. The centre returns fastest at critical damping, $c_2^\gamma = 2\sqrt{c_1^\gamma}$; beyond, one
# of its real poles creeps to 0. And the structure? It is stiffer, so it takes more, but the same happens to it in
# the end: for very large $D$ the slow poles are $s \approx -\omega'^2/(2\zeta')$ in the notation of the proof, and
# tend to 0.

# %%
sweep = stability.gain_sweep(
    law, rest.q, "c2_gamma", np.linspace(0.2, 4.0, 20) * 2.0 * np.sqrt(law.gains.c1_gamma), follow=False
)
figure, axes = plots.subplots(1, 2, size=(11, 3.6))
plots.gain_sweep(sweep, ax=axes[0])
rates = {}
for c2 in (4.0, 8.0, 12.0, 16.0, 20.0, 40.0, 100.0):
    damped = fl.Algorithm2(gains=fl.Gains(c2_gamma=c2), target=law.target)
    rates[c2] = fl.linearise(damped, rest.q).structural_decay_rate
    print(f"c2γ = {c2:5.1f}: the structure decays at the rate {rates[c2]:.3f}")
axes[1].semilogx(list(rates), list(rates.values()), "o-")
_ = axes[1].set(xlabel="$c_2^\\gamma$ (1/time)", ylabel="decay rate of the structure (1/time)", ylim=(0.0, None))

# %% tags=["facts"]
best_drawn = sweep.values[int(np.argmin(sweep.abscissa))]
assert abs(best_drawn - 2.0 * np.sqrt(law.gains.c1_gamma)) < 1e-12
assert rates[4.0] < rates[12.0] < rates[16.0] > rates[20.0] > rates[40.0] > rates[100.0]
assert np.allclose([rates[12.0], rates[20.0], rates[100.0]], [6.89, 5.12, 0.871], rtol=2e-3)
assert abs(measured - slow.decay_rate) < 5e-4
pair = fl.linearise(fl.Algorithm1(), [[0.0], [7.0]]).modes[0]
assert abs(pair.damping_ratio - 0.0929) < 1e-4
assert abs(abs(pair.eigenvalue) - 21.13) < 0.02
assert f"{margin.delay:.4f} {alone:.3f} {w:.3f} {w * alone:.3f} {w**2:.2f}" == "0.0127 0.617 2.159 1.332 4.66"
assert f"{abs(pair.eigenvalue) ** 2:.0f} {-2.0 * pair.eigenvalue.real:.2f}" == "447 3.93"


def grows(period, stiffness, damping):
    moved, pushed = [1.0, period], [-stiffness, -damping]
    step = np.array([np.add(moved, period**2 / 2.0 * np.array(pushed)), [period * pushed[0], 1.0 + period * pushed[1]]])
    return bool(np.abs(np.linalg.eigvals(step)).max() > 1.0)


assert [grows(share * 0.0177778, 450.0, 4.0) for share in (0.99, 1.01)] == [False, True]
assert [grows(share * 0.05, 450.0, 40.0) for share in (0.99, 1.01)] == [False, True]
assert slow.name == "breathing"

# %% [markdown]
# **Figure 6.5.** Left: the rightmost pole over $c_2^\gamma$. Right: the structure alone, whose decay rate grows until
# about $c_2^\gamma = 16$, to 8.6, and falls to 5.1 at 20 and to 0.87 at 100.
#
# So "more damping is better" is false twice: for the centre beyond 2.1, for the structure beyond 16.
#
# ## Questions that come up
#
# *Does stability of the linear model prove that of the flock?* Near the equilibrium, yes: if all poles are in the open
# left half-plane, the nonlinear law converges from a neighbourhood. With a zero mode of a symmetry one first divides
# the symmetry out. How large the neighbourhood is, the poles do not say.
#
# *Rate, damping ratio, frequency: which one does a customer ask for?* "How long until the picture stands" is the rate:
# to a hundredth in $\ln100$, that is 4.6, times its inverse. "Does it tremble" is the damping ratio. "How fast must the
# computer be" is the frequency.
#
# *Why not simply make all links softer?* Softer links bear more delay, longer periods and weaker friction. But then the
# wind moves them more: the variance of a mode is $g^2/(2d'\omega'^2)$.
#
# *The model has the same delay for everything. And if only the neighbours are late, not the agent's own sensors?* Then
# the diagonal terms of $D$ and $S$ act at once, only the others are late, and the margin is another one. State what
# is late before you compute.
#
# ## What surprised, and what the theorems do not say
#
# The slowest part of this flock is not its structure but its centre, and a designer who tunes the links tunes the
# wrong thing. The delay margin is set by the fastest part. The theorem on poles is about the linear system; that the
# nonlinear flock near a minimum behaves like it is true (the zero modes need care, see lecture 13), but *how near*
# is near, linearisation does not say. And nothing here says which equilibrium a flock reaches.
#
# ## Summary
#
# - Near an equilibrium a flock is a mechanical system $s^2I + sD + S$; symmetric $D > 0$, $S \ge 0$ put all poles in
#   the left half-plane, but for zero modes of a symmetry.
# - A linearisation is checked against the nonlinear law before it is used.
# - Sampled, a flock is a map: its multipliers must lie in the unit circle, and the stiffest modes leave it first. In
#   white noise its covariance solves Lyapunov's equation.
# - Poles, delay margin and gain sweeps follow from it; more damping helps up to a point, which differs for centre
#   and structure.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★★ (2 points, derivation) Linearise Algorithm 1, $c_2^\alpha > 0$, at an infinitesimally rigid α-lattice in
# *space*, at rest. How often does the first-order system of positions and velocities have the eigenvalue 0, counted
# with its algebraic multiplicity? (Translations lie in the kernels of both $S$ and $D$, rotations in that of $S$
# only. A whole number.)

# %% tags=["answer"]
zeros = ...

# %% tags=["solution"]
zeros = 2 * 3 + 3  # a translation gives a chain of two vectors: it may drift; a rotation is damped and gives one
drifting = fl.linearise(fl.Algorithm1(), lattice.hexagonal_patch(2, 7.0)).drifting
print("in the plane these drift:", drifting)

# %% tags=["check"]
grade(zeros, 9, hint="put x = a + tb into the linear equation: for which a and b does it solve it?")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, derivation) Two agents under Algorithm 1, 7 apart, at rest, as in the lecture, but with
# $c_1^\alpha = 60$. (a) What is the damping ratio of their distance with $c_2^\alpha = 2\sqrt{30}$? (b) Which
# $c_2^\alpha$ would make it 1? Give the list, each to three significant digits.

# %% tags=["answer"]
pair_damping = ...

# %% tags=["solution"]
ratio = fl.linearise(fl.Algorithm1(gains=fl.Gains(c1_alpha=60.0)), [[0.0], [7.0]]).modes[0].damping_ratio
pair_damping = [ratio, 2.0 * np.sqrt(30.0) / ratio]  # the ratio is proportional to c2α
print(pair_damping)

# %% tags=["check"]
grade(pair_damping, [0.06570384, 166.724675], digits=3, hint="there is one mode; how does its damping depend on c2α?")

# %% [markdown] tags=["exercise"]
# **3.** ★ (1 point, derivation) For which $c_2^\gamma$ does the centre of mass return fastest, with
# $c_1^\gamma = 2.5$? (Four significant digits.)

# %% tags=["answer"]
best = ...

# %% tags=["solution"]
best = 2 * np.sqrt(2.5)

# %% tags=["check"]
grade(best, 3.16227766, digits=4, hint="where do two real poles meet?")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, reading) `linearise` refuses a state that is no equilibrium. Try the *exact* hexagon of 19
# under `law`: what does it name, relative to the forces of the law? Give it to two significant digits. (Read the
# message of the error.)

# %% tags=["answer"]
residual = ...

# %% tags=["solution"]
try:
    fl.linearise(law, lattice.hexagonal_patch(2, 7.0))
except fl.errors.ArgumentError as error:
    print(error)
residual = fl.linearise(law, lattice.hexagonal_patch(2, 7.0), allow_residual=True).residual

# %% tags=["check"]
grade(residual, 0.04442693, digits=2, hint="the error says it, relative to the forces")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, design) Design: one agent follows a γ-agent at rest with $c_1^\gamma = 1$, $c_2^\gamma = 2$,
# and everything that it hears is late by $\tau$: $s^2 + (2s + 1)e^{-s\tau} = 0$. What is the delay margin, to four
# significant digits?

# %% tags=["answer"]
delay = ...

# %% tags=["solution"]
omega_c = np.sqrt((4.0 + np.sqrt(20.0)) / 2.0)  # ω⁴ = 1 + 4ω²
delay = np.arctan(2.0 * omega_c) / omega_c

# %% tags=["check"]
grade(delay, 0.647409203, digits=4, hint="two real equations, for ω and for τ")

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) The linearised flock has eigenvalues 0, and yet we say that its shape converges. Why is
# that no contradiction, and what does it mean for the place in which a flock ends? Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# The zero eigenvalues belong to rotations about the target: they move along the set of equilibria, on which the
# energy is constant, and do not change any distance. Across that set all eigenvalues have negative real part, so
# distances converge. Which equilibrium of the set is reached depends on the start and on any disturbance; the
# orientation is not controlled.
#
# **Rubric, a point each:** the zero modes are tangent to a set of equilibria of one shape; the orientation reached
# depends on the start.

# %% [markdown] tags=["exercise"]
# **7.** ★ (1 point, player) Play the motion of the slowest structural mode. How many times as far outwards as an
# agent of the inner ring does one of the outer ring move, on the average of its ring? (Two significant digits;
# `slow.shape` holds the displacements.)

# %% tags=["answer"]
ring_ratio = ...

# %% tags=["solution"]
radial = np.sum(slow.shape.real * rest.q, axis=1)  # positive: outwards
outside = np.linalg.norm(rest.q, axis=1)
inner, outer = (outside > 3.0) & (outside < 8.0), outside >= 8.0
ring_ratio = (radial[outer] / outside[outer]).mean() / (radial[inner] / outside[inner]).mean()

# %% tags=["check"]
grade(ring_ratio, 1.43712, digits=2, hint="the part of the displacement along the radius; watch one agent of each ring")

# %% [markdown] tags=["exercise"]
# **8.** ★★ (2 points, counterexample) Counterexample hunt: "If every agent by itself is damped, more friction makes
# every mode decay faster." Give two values $[c, c']$ of $c_2^\gamma$ with $0 < c < c' \le 100$ such that the
# structure of the hexagon decays more *slowly* at $c'$, by a factor of 2 at least.

# %% tags=["answer"]
slower = ...

# %% tags=["solution"]
slower = [16.0, 100.0]

# %% tags=["check"]
grade(
    slower,
    lambda c: (
        len(c) == 2
        and 0.0 < c[0] < c[1] <= 100.0
        and next(
            rate[0] >= 2.0 * rate[1]
            for rate in [
                [
                    fl.linearise(
                        fl.Algorithm2(gains=fl.Gains(c2_gamma=each), target=fl.StaticTarget((0.0, 0.0))),
                        fl.find_equilibrium(
                            fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0))), lattice.hexagonal_patch(2, 7.0)
                        ),
                    ).structural_decay_rate
                    for each in c
                ]
            ]
        )
    ),
    form="list",
    hint="the table of the sweep",
)

# %% [markdown] tags=["exercise"]
# **9.** ★★★ (3 points, proof) Prove: if $D$ commutes with $S$, the flock decomposes into independent oscillators,
# and give $\omega_n$ and $\zeta$ of each. Show that for Algorithm 2 with $c_2^\alpha = 0$ this is so, and conclude
# which $c_2^\gamma$ makes the slowest structural oscillator decay fastest.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Commuting symmetric matrices have a common orthonormal basis of eigenvectors $\nu_k$. In it
# $\tilde x = \sum z_k\nu_k$, and each $z_k$ obeys $\ddot z_k + 2\zeta_k\omega_k\dot z_k + \omega_k^2z_k = 0$ with
# $\omega_k^2$ the eigenvalue of $S$ and $2\zeta_k\omega_k$ that of $D$. With $c_2^\alpha = 0$ one has
# $D = c_2^\gamma I$, which commutes with everything, and $\zeta_k = c_2^\gamma/(2\omega_k)$. An oscillator decays at
# the rate $c_2^\gamma/2$ while $\zeta_k < 1$, and at $c_2^\gamma/2 - \sqrt{(c_2^\gamma)^2/4 - \omega_k^2}$ beyond,
# which falls. The structure's rate is the minimum over $k$; the softest mode reaches its peak first, so the best
# choice is $c_2^\gamma = 2\omega_{\min}$ with the least positive $\omega_k$ of the structure.
#
# **Rubric, a point each:** simultaneous diagonalisation with $\omega_k$ and $\zeta_k$; the case $c_2^\alpha = 0$;
# the optimum with its reason.

# %% [markdown] tags=["exercise"]
# **10.** ★★★ (3 points, project) Open project, about two weeks: how does the slowest structural decay rate of a
# hexagonal patch depend on the number of agents, $n = 7, 19, 37, 61, \dots$, and on $c_1^\gamma$? Predict it by a
# continuum (an elastic disc with friction), compute it, check one point against a nonlinear run, and discuss what it
# means for a show of three hundred drones. Hand in a page with figures.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# A good answer follows the equilibrium as the gains change, reports rates with the mode's name, finds how the
# softest frequency falls with the radius of the patch, and compares with an independent estimate (for instance the
# breathing mode of an elastic disc, frequency inversely proportional to its radius). It verifies one rate by a
# nonlinear run as in the lecture.
#
# **Rubric, a point each:** a table or figure of rates over $n$ and $c_1^\gamma$, with equilibria found anew; an
# independent prediction with its assumptions; a nonlinear check and a conclusion.

# %% [markdown] tags=["exercise"]
# **11.** ★★ (2 points, derivation) One mode of a flock has the stiffness $\omega'^2 = 400$ and the damping $d' = 4$.
# (a) Up to which sampling period does it decay? (b) What variance does its coordinate have in white noise of
# intensity 2? (c) What variance if $d'$ is doubled? Give the list, exactly.

# %% tags=["answer"]
one_mode = ...

# %% tags=["solution"]
one_mode = [2.0 * 4.0 / 400.0, 4.0 / (2.0 * 4.0 * 400.0), 4.0 / (2.0 * 8.0 * 400.0)]

# %% tags=["check"]
grade(one_mode, [0.02, 0.00125, 0.000625], hint="both formulas are in the part on sampling and noise")

# %% [markdown] tags=["exercise"]
# **12.** ★★ (2 points, experiment) The hexagon of seven agents under the law of the lecture, at its equilibrium
# (`fl.find_equilibrium(law, lattice.hexagonal_patch(1, 7.0))`): what is its sampling margin (a), and how many times
# its delay margin is that (b)? Give the list, each to three significant digits.

# %% tags=["answer"]
seven_sampled = ...

# %% tags=["solution"]
seven = fl.find_equilibrium(law, lattice.hexagonal_patch(1, 7.0))
longest = stability.sampling_margin(law, seven).period
seven_sampled = [longest, longest / fl.linearise(law, seven).delay_margin().delay]
print(seven_sampled)

# %% tags=["check"]
grade(seven_sampled, [0.0262623035, 2.05451], digits=3, hint="sampling_margin(...).period, delay_margin(...).delay")
