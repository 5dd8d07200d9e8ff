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
# # Algorithm 2: cohesion, and the γ-agent as a linear system
#
# **Aims.** Split a flock exactly into its shape and its centre; prove the four parts of Theorem 3; read the centre
# of mass as a filter of second order; explain two figures of a course project by a transfer function.
#
# ## A scene
#
# The picture of three hundred drones has to move across the sky, so the director gives all drones the same moving
# point to follow. In the rehearsal the picture circles, as it should, but on a smaller circle than the point does.
# "The drones start inside the circle", says one engineer; "the point is too fast", says another. **What decides the
# size of the circle, and why does the picture not fall apart now, when under Algorithm 1 it did?** Both answers come
# from one algebraic fact: the flock splits into two systems that do not see each other.
#
# ## Two agents and a target on a line
#
# Algorithm 2 of Olfati-Saber (2006, section V) adds to Algorithm 1 a spring and a damper to a γ-agent with position
# $q_r$ and velocity $p_r$, on each agent:
#
# $$u_i = u_i^\alpha - c_1^\gamma (q_i - q_r) - c_2^\gamma (p_i - p_r) .$$
#
# Take two agents on a line. Half the sum of the two equations and their difference, $q_c = \tfrac12(q_1+q_2)$ and
# $y = q_2 - q_1$, are
#
# $$\begin{aligned}
# \ddot q_c &= -c_1^\gamma(q_c - q_r) - c_2^\gamma(\dot q_c - p_r), && \text{pair forces cancel} \\
# \ddot y &= -2c_1^\alpha\phi_\alpha(\|y\|_\sigma)\tfrac{y}{\sqrt{1+\varepsilon y^2}} - 2c_2^\alpha a_{12}\dot y -
#   c_1^\gamma y - c_2^\gamma\dot y . && q_r, p_r \text{ cancel}
# \end{aligned}$$
#
# The centre does not know that there is a neighbour, and the distance does not know that there is a target. The
# distance has got a further spring, $-c_1^\gamma y$, with no end of range: whatever the pair does, it is drawn
# together.
#
# ## Two systems in one
#
# For $n$ agents put $q_c = \tfrac1n\sum q_i$, $p_c = \tfrac1n\sum p_i$, $x_i = q_i - q_c$ and $v_i = p_i - p_c$.
#
# > **Theorem (split).** Under Algorithm 2, for every motion of the γ-agent,
# >
# > $$\dot p_c = -c_1^\gamma(q_c - q_r) - c_2^\gamma(p_c - p_r),$$
# >
# > $$\dot v_i = u_i^\alpha(x, v) - c_1^\gamma x_i - c_2^\gamma v_i .$$
#
# *Proof.*
#
# 1. $u_i^\alpha$ depends on differences $q_j - q_i = x_j - x_i$ and $p_j - p_i = v_j - v_i$ only, so
#    $u_i^\alpha(q,p) = u_i^\alpha(x,v)$.
# 2. $\sum_iu_i^\alpha = 0$: pairs cancel (lecture 02).
# 3. The mean over $i$ of the law is, by 2, $\dot p_c = -c_1^\gamma(q_c - q_r) - c_2^\gamma(p_c - p_r)$. The feedback
#    is *linear*, so the mean of the feedbacks is the feedback of the means.
# 4. Subtract this from the law of agent $i$:
#    $\dot v_i = u_i^\alpha - c_1^\gamma(q_i - q_c) - c_2^\gamma(p_i - p_c)$, in which $q_r$ and $p_r$ have
#    cancelled. $\square$
#
# <details><summary>With numbers</summary>
#
# *With numbers.* Three agents on a line at $-4$, $1$ and $6$, all at rest, the γ-agent at rest in $10$, $c_1^\gamma =
# 1.1$. The centre is at $q_c = 1$, so $x = (-5, 0, 5)$. The γ-agent pulls with $1.1\cdot(14, 9, 4) = (15.4, 9.9, 4.4)$.
# The mean of the three pulls is $9.9 = 1.1\cdot(10 - 1)$: that moves the centre. What is left over is $(5.5, 0, -5.5) =
# -1.1\,x$: it presses the three together, and would be the same with the γ-agent anywhere else.
#
# </details>
#
# Step 3 is where linearity is used. Algorithm 3 of lecture 05 bounds the pull by a nonlinear function, and the split
# is lost. The library checks the split symbolically:

# %%
import numpy as np
import sympy

import flockana as fl
from flockana import plots, symbolic
from flockana.course import Prediction, figures, grade

split = symbolic.derive_split(m=2)
print("exact:", split.holds)
figure, ax = plots.subplots(size=(6, 3.4))
_ = figures.target_pull(ax=ax)

# %% [markdown]
# **Figure 3.1.** The pull of a γ-agent. Its mean over the agents acts on the centre (cross); what is left over,
# $-c_1^\gamma x_i$, draws every agent to the *centre*, wherever the γ-agent is.
#
# ## The shape: an energy with bounded level sets
#
# Let $\lambda = c_1^\gamma$, $J(x) = \tfrac12\sum\|x_i\|^2$, $K(v) = \tfrac12\sum\|v_i\|^2$, and with the potential
# $V$ of lecture 02
#
# $$U_\lambda = c_1^\alpha V + \lambda J, \qquad H_\lambda = U_\lambda + K .$$
#
# As $\nabla_{x_i}J = x_i$, the shape obeys
# $\dot v = -\nabla U_\lambda(x) - (c_2^\gamma I + c_2^\alpha\hat L(x))\,v$, and so, as in lecture 02,
#
# $$\begin{aligned}
# \dot H_\lambda &= \langle\nabla U_\lambda, v\rangle + \langle v, -\nabla U_\lambda - c_2^\gamma v - c_2^\alpha\hat
#   Lv\rangle && \text{chain rule, law} \\
# &= -c_2^\gamma\sum\|v_i\|^2 - c_2^\alpha\,v^\top\hat Lv \le 0 . && \text{the gradient cancels}
# \end{aligned}$$
#
# > **Theorem 3** (Olfati-Saber 2006, as lecture slides on it print it). Apply Algorithm 2 with
# > $c_1^\gamma, c_2^\gamma > 0$, and let $K(v(0))$ and $J(x(0))$ be finite. Then (i) the group is cohesive for all
# > $t \ge 0$; (ii) almost every solution converges to an equilibrium $(x_\lambda^*, 0)$ where $x_\lambda^*$ is a local
# > minimum of $U_\lambda$; (iii) all agents asymptotically move with the same velocity; (iv) if
# > $H_\lambda(0) < (k+1)\,c^*$ with $c^* = c_1^\alpha\psi_\alpha(0)$, at most $k$ distinct pairs of agents can collide,
# > and none if $k = 0$.
#
# *Proof of (i).* All terms of $H_\lambda$ are non-negative, and one agent at the distance $\|x_i\|$ from the centre
# has $\lambda J \ge \tfrac\lambda2\|x_i\|^2$. So
#
# $$\tfrac\lambda2\|x_i(t)\|^2 \le H_\lambda(t) \le H_\lambda(0) \quad\Longrightarrow\quad R(t) = \max_i\|x_i(t)\|
#   \le \sqrt{2H_\lambda(t)/c_1^\gamma} \le \sqrt{2H_\lambda(0)/c_1^\gamma} . \quad\square$$
#
# This is the step that failed for Algorithm 1, and it took one line: $J$ grows without bound.
#
# <details><summary>With numbers</summary>
#
# *With numbers.* Two agents at rest, 10 apart, out of each other's range, with the gains of the paper, $c_1^\alpha =
# 30$ and $c_1^\gamma = 1.1$: $V = \psi_\alpha(r_\alpha) = 0.736$, $J = \tfrac12(5^2 + 5^2) = 25$, so
# $H_\lambda(0) = 30\cdot0.736 + 1.1\cdot25 = 22.1 + 27.5 = 49.6$ and $R \le \sqrt{2\cdot49.6/1.1} = 9.5$. In truth the
# two are drawn together at once, and $R$ never exceeds the 5 of the start. Nearly half of the bound's square comes from
# $c_1^\alpha V$, a constant that no agent can turn into distance while all are out of range. With 150 agents, 11 175
# pairs, this part dominates by far, which is why the bound in the next figure lies so high. A bound that is true for
# *every* start cannot know that this one is harmless.
#
# </details>
#
# *Proof of (iii), and of convergence to critical points.*
#
# 1. The set $\{H_\lambda \le H_\lambda(0)\}$ is closed; it is bounded by (i) and $K \le H_\lambda(0)$; so it is
#    compact. It is positively invariant, as $\dot H_\lambda \le 0$.
# 2. The shape's equation has no explicit time, though the γ-agent may move at will. So LaSalle's theorem applies:
#    the solution approaches an invariant set on which $\dot H_\lambda = 0$.
# 3. There $\sum\|v_i\|^2 = 0$, because $c_2^\gamma > 0$. So $v \to 0$: (iii). No connectedness is needed.
# 4. By invariance $\dot v = 0$ there too, so $\nabla U_\lambda = 0$: the shape approaches the critical points of
#    $U_\lambda$. $\square$
#
# *On (ii): why only minima are seen.* Near a critical point $x^*$ the linearised shape is
# $\ddot{\tilde x} + D\dot{\tilde x} + S\tilde x = 0$ with the symmetric matrices $S = \nabla^2U_\lambda(x^*)$ and
# $D = c_2^\gamma I + c_2^\alpha\hat L(x^*)$.
#
# > **Lemma.** If $S$ has a negative eigenvalue, the linearised shape has a real pole $s > 0$.
#
# *Proof.* For real $s$ the matrix $s^2I + sD + S$ is symmetric, so its least eigenvalue is real and depends
# continuously on $s$. At $s = 0$ the matrix is $S$, and its least eigenvalue is negative. For large $s$ it is
# positive, because $s^2$ dominates. So at some $s > 0$ it is 0: there is $\nu \ne 0$ with $(s^2I + sD + S)\nu = 0$,
# and $\tilde x = e^{st}\nu$ solves the equation. $\square$
#
# <details><summary>Why minima: the proof's idea, and two gaps that are closed</summary>
#
# What is the use of such a pole? Take one coordinate, $\ddot{\tilde x} + 2\dot{\tilde x} - 3\tilde x = 0$, with the
# poles 1 and $-3$. All solutions are sums of multiples of $e^t$ and $e^{-3t}$, and only those without $e^t$ converge
# to 0. They start on the line $\dot{\tilde x} = -3\tilde x$ of the plane of states, and a start drawn at random is not
# on a line. For the nonlinear law the line becomes a curved surface. Two gaps must be closed, for in the plane *every*
# critical point has a pole 0 besides: turned about the γ-agent, it is a critical point again.
#
# 1. *Poles 0.* The *centre-stable manifold theorem* holds with them. Each critical point with a pole $s > 0$ has a
#    neighbourhood in which the starts whose solutions never leave it lie on a surface of a dimension lower than
#    that of the space of states: its measure is 0.
# 2. *A continuum of critical points.* Countably many such neighbourhoods cover all these critical points. A solution
#    that converges to one of them is from some whole time $k$ on in one neighbourhood for ever, so its start is among
#    countably many sets of measure 0, each carried back by $k$, and a smooth flow carries measure 0 to measure 0.
# 3. *Convergence to one point.* That solutions converge to one critical point, and not only to the set of them, follows
#    from Łojasiewicz's inequality, because $\phi_\alpha$ is analytic in pieces (`proofs/convergence.py`).
#
# So from almost every start the shape converges to one critical point without a negative curvature. Whether it is a
# strict minimum, up to motions, must be asked of the point: further curvatures may be 0. $\square$
#
# </details>
#
# *Proof of (iv), as far as it is true.* Let $k+1$ pairs coincide *at one time*. Each costs
# $c_1^\alpha\psi_\alpha(0) = c^*$, and all other terms are non-negative, so $H_\lambda \ge (k+1)c^* > H_\lambda(0)$,
# against $\dot H_\lambda \le 0$. So at most $k$ pairs coincide at any one time, and for $k = 0$ none ever. $\square$
# Over time *more* pairs may collide, one after another, and (iv) is false as printed for $k \ge 1$ (erratum E13,
# lecture 07).

# %%
flock = fl.scenario("paper-flocking").run()
bound = np.sqrt(2.0 * flock.energy() / flock.law.gains.c1_gamma)
figure, axes = plots.subplots(1, 3, size=(13, 3.6))
plots.snapshot(flock, ax=axes[0], bar=False)
plots.measure(flock, "cohesion_radius", ax=axes[1])
axes[1].plot(flock.t, bound, "k:", label="bound √(2H_λ(t)/c1γ)")
axes[1].set(yscale="log", ylim=(30.0, 2000.0))
axes[1].legend()
_ = plots.energy(flock, ax=axes[2])
print({claim.name: claim.status for claim in fl.verify("os-3", flock).claims})

# %% [markdown]
# **Figure 3.2.** The 150 agents of lecture 00. Middle: their radius $R(t)$ and the bound of (i), which is true and
# far above, because most of $H_\lambda$ is $c_1^\alpha V$, to which every pair out of range contributes. Right: the
# energy.
#
# ## An experiment: the shape does not see the target
#
# The split is exact, so here is a test that would fail if anything were wrong with it. Let the same nineteen agents
# follow a target at rest, one on a straight line, and one on a circle. Their shapes $x(t)$ must be the same, to the
# accuracy of the integrator, although the flocks fly along quite different paths.

# %%
generator = np.random.default_rng(3)
begin = fl.lattice.hexagonal_patch(2, 7.0) + generator.normal(0.0, 1.0, (19, 2))
moving = generator.normal(0.0, 1.0, (19, 2))
targets = {
    "at rest": fl.StaticTarget((0.0, 0.0)),
    "on a line": fl.LinearTarget((10.0, 0.0), (5.0, 1.0)),
    "on a circle": fl.CircleTarget((0.0, 0.0), 20.0, 0.2),
}
paths = {
    name: fl.simulate(fl.Algorithm2(target=target), begin, moving, (0.0, 5.0), t_eval=np.linspace(0.0, 5.0, 101))
    for name, target in targets.items()
}
shape = {name: path.q - path.q.mean(axis=1, keepdims=True) for name, path in paths.items()}
for name, path in paths.items():
    drift = np.linalg.norm(path.q[-1].mean(axis=0) - path.q[0].mean(axis=0))
    off = abs(shape[name] - shape["at rest"]).max()
    print(f"target {name:>11}: the centre has moved {drift:6.2f}, the shape differs by {off:.0e}")

# %% tags=["facts"]
assert max(abs(shape[name] - shape["at rest"]).max() for name in shape) < 1e-5
assert np.linalg.norm(paths["on a line"].q[-1].mean(axis=0)) > 20.0
two = fl.Algorithm2(target=fl.StaticTarget((0.0,)))
level = two.gains.c1_alpha * float(two.alpha.psi_alpha(two.alpha.r_alpha)) + two.gains.c1_gamma * 25.0
assert f"{level:.1f} {np.sqrt(2.0 * level / two.gains.c1_gamma):.1f}" == "49.6 9.5"
drawn = fl.simulate(two, [[-5.0], [5.0]], [[0.0], [0.0]], (0.0, 10.0))
assert abs(drawn.energy()[0] - level) < 1e-6
assert np.abs(drawn.q).max() <= 5.0 + 1e-9
row = np.array([[-4.0], [1.0], [6.0]])
felt = [fl.Algorithm2(target=fl.StaticTarget((place,))).acceleration(0.0, row, 0.0 * row) for place in (1.0, 10.0)]
assert np.allclose(felt[1] - felt[0], 9.9)  # the same on all three

# %% [markdown]
# The shapes agree to many digits. For a designer this is good news: cohesion, matching and the pattern can be tuned
# with a target at rest, once, and the path of the target is a matter of the filter alone. It also says what a target
# can *not* do: no path, however clever, shakes a flock into a better pattern, because the shape does not feel it.
# Obstacles can, and so can a target that only some agents know: then the sum in step 3 of the proof no longer
# closes, the shape has explicit time in it, LaSalle's theorem does not apply, and one needs Barbalat's lemma
# (lecture 00a). Lecture 12 has such a law.
#
# ## The centre: a filter of second order
#
# The centre obeys $\ddot q_c = -c_1^\gamma (q_c - q_r) - c_2^\gamma (\dot q_c - p_r)$, exactly and whatever the
# shape does. Let first $p_r = \dot q_r$, and take Laplace transforms with zero initial values, $s$ for the
# derivative:
#
# $$\begin{aligned}
# s^2q_c &= -c_1^\gamma(q_c - q_r) - c_2^\gamma(s\,q_c - s\,q_r) && \text{transform} \\
# (s^2 + c_2^\gamma s + c_1^\gamma)\,q_c &= (c_2^\gamma s + c_1^\gamma)\,q_r && \text{collect} \\
# \frac{q_c}{q_r} &= \frac{c_2^\gamma s + c_1^\gamma}{s^2 + c_2^\gamma s + c_1^\gamma} . && \text{divide}
# \end{aligned}$$
#
# Compare the denominator with $s^2 + 2\zeta\omega_ns + \omega_n^2$: the natural frequency is
# $\omega_n = \sqrt{c_1^\gamma}$, the damping ratio $\zeta = c_2^\gamma/(2\sqrt{c_1^\gamma})$. If the γ-agent reports
# the velocity $p_r = k_v\,\dot q_r$ instead of the true one, only the zero moves: $c_2^\gamma s$ in the numerator
# becomes $k_vc_2^\gamma s$. sympy agrees:

# %%
symbolic.transfer_function(sympy.Symbol("k_v"))

# %% [markdown]
# ## Two cases of a project
#
# A course project (`fl.cite(fl.scenario("msn-case1"))`) asks for four simulations of 100 agents; assignment A1 sets
# them all. Here are two. **A target at rest, no damping** ($c_2^\gamma = 0$): the flock swings through the target and
# back, for $\zeta = 0$. Here $c_1^\gamma = 1$, so the period must be $2\pi/\omega_n = 2\pi$. Measure it: the velocity
# of the centre changes its sign after half a period.

# %%
case2 = fl.scenario("msn-case2").run()
speed = case2.p.mean(axis=1)[:, 0]
turn = next(k for k in range(5, len(speed)) if speed[k - 1] > 0.0 >= speed[k])
half = case2.t[turn - 1] + speed[turn - 1] / (speed[turn - 1] - speed[turn]) * (case2.t[turn] - case2.t[turn - 1])
print(f"period: {2.0 * np.pi:.4f} predicted, {2.0 * half:.4f} measured")

# %% [markdown]
# **A target on a circle** of radius 100. The flock follows, on a smaller circle:

# %%
case4 = fl.scenario("msn-case4").run()
figure, axes = plots.subplots(1, 2, size=(10, 4.2))
plots.trajectories(case4, ax=axes[0])
_ = plots.centre_path(case4, ax=axes[1])
case4.player(height=460)

# %% [markdown]
# **Figure 3.3.** Case 4 of the project: all paths, and the path of the centre beside the target's.
#
# ## Why is the circle smaller?
#
# The project saw that, and laid it to a start inside the circle and to the speed of the target. The filter has
# another answer (errata E12 and E15). The project moves its γ-agent by iterations of 0.009 time units, but the $p_r$
# that it hands over is the change *per iteration*: $k_v = 0.009$. On a circle at the angular velocity $\omega$ the
# ratio of the radii is the modulus of the transfer function at $s = i\omega$. Compute it, and measure it, for the
# printed $p_r$ and for the true one:

# %%
c1, c2 = case4.law.gains.c1_gamma, case4.law.gains.c2_gamma
circle = case4.law.target.target
omega = 2.0 * np.pi * circle.frequency


def gain(k_v, omega):
    s = 1j * omega
    return abs((k_v * c2 * s + c1) / (s**2 + c2 * s + c1))


true = fl.simulate(fl.Algorithm2(case4.law.alpha, case4.law.gains, circle), case4.q[0], case4.p[0], case4.t[[0, -1]])

# %% tags=["predict"]
guess = ...
Prediction(
    "And with the true velocity: how large is the flock's circle then, over the target's?",
    guess,
    float(gain(1.0, omega)),
)

# %%
for k_v, run in ((0.009, case4), (1.0, true)):
    radius = np.linalg.norm(run.q[-1].mean(axis=0) - 50.0)  # of the centre about (50, 50), at the end
    print(f"k_v = {k_v:5}: ratio {gain(k_v, omega):.3f} predicted, {radius / 100.0:.3f} measured")
frequencies = np.geomspace(0.3, 100.0, 200)
figure, ax = plots.subplots(size=(6, 3.4))
for k_v in (0.009, 1.0):
    ax.semilogx(frequencies, gain(k_v, frequencies), label=f"k_v = {k_v:g}")
    ax.plot(omega, gain(k_v, omega), "o", color="black")
ax.axvline(omega, color="0.5", linestyle=":")
ax.set(xlabel="ω (1/time)", ylabel="|q_c/q_r|")
_ = ax.legend()

# %% tags=["facts"]
found = [np.linalg.norm(r.q[-1].mean(axis=0) - 50.0) / 100.0 for r in (case4, true)]
assert np.allclose(found, [gain(0.009, omega), gain(1.0, omega)], atol=2e-3)
assert f"{gain(0.009, omega):.2f} {gain(1.0, omega):.2f}" == "0.85 1.11"
assert abs(2.0 * half - 2.0 * np.pi) < 1e-3
assert f"{omega:.3f} {omega**2:.2f} {c2:.2f} {0.009 * c2 * omega:.2f} {c2 * omega:.1f}" == "3.491 12.18 16.73 0.53 58.4"
assert f"{gain(0.009, omega):.3f} {gain(1.0, omega):.3f} {np.hypot(70.0, c2 * omega):.1f}" == "0.852 1.109 91.2"
assert gain(1.0, 0.999 * np.sqrt(2.0 * c1)) > 1.0 > gain(1.0, 1.001 * np.sqrt(2.0 * c1))
assert f"{np.sqrt(2.0 * c1):.1f}" == "11.8"
shares = bound / flock.metrics()["cohesion_radius"].values
assert 5.0 < shares.min() < shares.max() < 25.0

# %% [markdown]
# **Figure 3.4.** The gain from the γ-agent to the centre over the frequency, for both velocities; the dotted line is
# the $\omega$ of case 4. With $k_v = 0.009$ the ratio is 0.85; with the true velocity it is 1.11, and the flock's
# circle would be *larger* than the target's.
#
# <details><summary>By hand</summary>
#
# *By hand.* The gains are $c_1^\gamma = 70$ and $c_2^\gamma = 2\sqrt{70} = 16.73$, so the damping is critical and the
# denominator is the square $(s + \omega_n)^2$, of modulus $\omega^2 + \omega_n^2$ at $s = i\omega$. Here $\omega =
# 3.491$ and $\omega^2 = 12.18$, so the modulus is $12.18 + 70 = 82.18$. The numerator is $70 +
# 0.009\cdot16.73\cdot3.491\,i$, whose imaginary part, 0.53, hardly counts: the ratio is $70/82.18 = 0.852$. With the
# true velocity the imaginary part is $58.4$, the modulus $\sqrt{70^2 + 58.4^2} = 91.2$, and the ratio $91.2/82.18 =
# 1.109$.
#
# </details>
#
# Is a flock that knows the true velocity always on a larger circle? At critical damping and with $k_v = 1$
#
# $$\begin{aligned}
# \Bigl|\frac{q_c}{q_r}\Bigr|^2 &= \frac{\omega_n^4 + 4\omega_n^2\omega^2}{(\omega^2 + \omega_n^2)^2} &&
#   c_2^\gamma = 2\omega_n \\
# &= 1 + \frac{\omega^2\,(2\omega_n^2 - \omega^2)}{(\omega^2 + \omega_n^2)^2} , && \text{denominator taken out}
# \end{aligned}$$
#
# which is above 1 exactly for $\omega < \sqrt2\,\omega_n = 11.8$. The reason is visible in the law: on a circle the
# velocity points along the tangent, and whoever copies it a little late is carried outwards. For faster circles the
# mass of the flock wins.
#
# Neither the start nor the speed as such explains it. What comes from the start is a solution of the homogeneous
# equation, and decays with the poles.
#
# ## Too strong a pull
#
# The same $\lambda$ that holds the flock together presses on every link. Beyond a ratio $c_1^\gamma/c_1^\alpha$ that
# falls with $n$, some agents share one place, in a strict local minimum of $U_\lambda$ (erratum E11). Theorem 3 is
# not violated: it promises a minimum of $U_\lambda$, and no lattice.
#
# > **Proposition (two agents).** Two agents have only one equilibrium, in which they coincide, exactly if
# > $c_1^\gamma \ge 2c_1^\alpha|\phi_\alpha(0)|$.
#
# *Proof.* At the distance $y \le d$ the force on their distance is $-y\,\bigl[2c_1^\alpha
# \phi_\alpha(\|y\|_\sigma)/\sqrt{1+\varepsilon y^2} + c_1^\gamma\bigr]$, by the second section. The first term in the
# bracket is negative and rises with $y$ to 0 at $d$: $|\phi_\alpha|$ falls and the root grows. So the bracket rises,
# from $c_1^\gamma - 2c_1^\alpha|\phi_\alpha(0)|$ at $y = 0$. If that is negative, it vanishes at one distance $0 < y <
# d$, where the pair rests apart; else only $y = 0$ is left. Beyond $d$ all forces attract. $\square$
#
# With $a = b = 5$ one has $|\phi_\alpha(0)| = 4.99$, so the ratio is $9.98$ for two. For nineteen it is much lower: the
# agents in the middle are pressed together by all those outside, and each pair force is bounded. Move the ratio, and
# watch nineteen agents; a number beside an agent counts those in its place:

# %%
from flockana.course.picture_slider import slider

patch = fl.lattice.hexagonal_spiral(19, 7.0) + 7e-4 * np.random.default_rng(0).standard_normal((19, 2))


def settle(q, ratio):
    pull = fl.Gains(c1_alpha=1.0, c1_gamma=ratio)
    return fl.find_equilibrium(fl.Algorithm2(gains=pull, target=fl.StaticTarget((0.0, 0.0))), q)


ratios = (0.05, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.6, 2.0, 3.0)
settled = {ratio: settle(patch, ratio) for ratio in ratios}


def at_rest(ax, ratio):
    rest = settled[ratio]
    title = f"{rest.kind}, closest pair {fl.min_distance(rest.q):.3g}"
    plots.configuration(rest.q, d=7.0, r=8.4, ax=ax, bar=False, title=title)
    ax.set_aspect("equal", adjustable="box")
    ax.set(xlim=(-18.0, 18.0), ylim=(-18.0, 18.0))


slider(at_rest, ratios, name="c1γ/c1α", title="nineteen agents at rest", size=(4.6, 4.6), start=2)

# %% tags=["facts"]
places = len(np.unique(np.round(settled[3.0].q, 4), axis=0))
assert 1 < places < 19  # some share a place, not all
needed = 2.0 * abs(float(fl.AlphaInteraction().phi_alpha(0.0)))
assert f"{needed:.2f}" == "9.98"
assert fl.min_distance(settle(patch[:2], 0.99 * needed).q) > 0.1
assert fl.min_distance(settle(patch[:2], 1.1 * needed).q) < 1e-6

# %% [markdown]
# ## Questions that come up
#
# *Does cohesion mean that the flock ends as one net?* No. Cohesion says that a ball holds all agents. But at rest one
# can say more. Add up the forces on all agents of one component: the pair forces cancel, and
# $-c_1^\gamma\sum x_i = 0$ is left, so *every component has its centre at the centre of the flock*. Two components side
# by side are excluded. A ring about a smaller component is not excluded by this argument.
#
# *Velocities tend to 0. So does each agent come to rest at one place?* In the frame of the centre the velocity
# tends to 0, but $\ln(1+t)$ has a velocity that tends to 0, too, and it does not converge. LaSalle's theorem gives
# convergence to a *set*. Lecture 13 proves more near a minimum.
#
# *What if the agents have different gains $c_1^\gamma$?* Step 3 of the split fails: the mean of
# $c_i(q_i - q_r)$ is not a gain times $q_c - q_r$. Then the shape feels the target, and one has to begin anew.
#
# *Do we still need the friction between neighbours, $c_2^\alpha$?* Not for Theorem 3: set it to 0, and each line of the
# proof still holds. It matters for how *fast* the links calm down (lecture 06).
#
# *The pull has no end of range. Is that realistic?* Each agent must know $q_r$ and $p_r$, by radio or from a common
# plan. That is the price of the one-line proof of cohesion. Lecture 12 has laws in which few agents know the target.
#
# ## What surprised, and what the theorem does not say
#
# Cohesion has a one-line proof, and its constant is useless for design: here the bound is some ten times the radius.
# A moving target does no harm to the shape, none at all: the split is exact. A wrong unit in $p_r$ looks like a law
# of nature in the figures. And Theorem 3 does not say that the flock ends as one connected net, nor near a lattice,
# nor how fast: for the speed see lecture 06.
#
# ## Summary
#
# - Algorithm 2 splits exactly into a shape, which dissipates $H_\lambda$, and a centre of mass, which is a linear
#   filter of second order.
# - $J$ in the energy bounds the size of the flock: cohesion holds with a constant, velocities match by LaSalle, and
#   only minima attract more than exceptional solutions.
# - The velocity that the γ-agent reports moves the zero of the filter; that explains circles that are too small or
#   too large.
# - Too strong a pull squeezes agents together.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, derivation) Let $c_1^\gamma = 50$. Which $c_2^\gamma$ makes the centre of mass critically damped
# ($\zeta = 1$)? (Four significant digits.)

# %% tags=["answer"]
c2_gamma = ...

# %% tags=["solution"]
c2_gamma = 2 * np.sqrt(50)

# %% tags=["check"]
grade(c2_gamma, 14.1421356, digits=4, hint="compare the characteristic polynomial with (s + ω_n)²")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, design) For which $k_v$ between 0 and 1 would the flock of case 4 follow on a circle of
# exactly the right size? (Four significant digits.)

# %% tags=["answer"]
right_share = ...

# %% tags=["solution"]
from scipy.optimize import brentq

right_share = brentq(lambda share: gain(share, omega) - 1.0, 0.0, 1.0)

# %% tags=["check"]
grade(right_share, 0.7372359, digits=4, hint="set the squared moduli of numerator and denominator equal")

# %% [markdown] tags=["exercise"]
# **3.** ★★ (2 points, derivation) A γ-agent on a straight line moves at speed 3 and reports $p_r = k_v\cdot3$;
# $c_1^\gamma = 1.1$ and $c_2^\gamma = 2\sqrt{1.1}$. How far behind does the centre stay in the long run (a) for
# $k_v = 0$, (b) for $k_v = 0.5$, (c) for $k_v = 1$? (Set $\ddot q_c = 0$. A list, each number to four significant
# digits.)

# %% tags=["answer"]
lag = ...

# %% tags=["solution"]
lag = [2 * np.sqrt(1.1) * 3 * (1 - share) / 1.1 for share in (0.0, 0.5, 1.0)]

# %% tags=["check"]
grade(lag, [5.7207755, 2.86038777, 0.0], digits=4, hint="which two forces on the centre balance?")

# %% [markdown] tags=["exercise"]
# **4.** ★ (1 point, experiment) At $c_1^\gamma/c_1^\alpha = 3$ some of nineteen agents share a place. How near are the
# nearest two of seven? Settle them. (Three significant digits.)

# %% tags=["answer"]
nearest = ...

# %% tags=["solution"]
nearest = fl.min_distance(settle(patch[:7], 3.0).q)

# %% tags=["check"]
grade(nearest, 5.45931, digits=3, hint="fl.min_distance(settle(patch[:7], 3.0).q)")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, design) Design: choose $c_1^\gamma$ and $c_2^\gamma$, neither above 5, such that every start
# of the centre of mass decays at least as fast as a constant times $e^{-2t}$. Give the list
# $[c_1^\gamma, c_2^\gamma]$. (A double pole at $-2$ gives $te^{-2t}$, which is slower.)

# %% tags=["answer"]
chosen = ...

# %% tags=["solution"]
chosen = [4.8, 4.2]  # poles of s² + c2γ s + c1γ; with s = z − 2: c2γ ≥ 4 and c1γ ≥ 2 c2γ − 4

# %% tags=["check"]
grade(
    chosen,
    lambda g: (
        len(g) == 2
        and max(g) <= 5.0
        and g[1] >= 4.0 - 1e-9
        and g[0] >= 2.0 * g[1] - 4.0 - 1e-9
        and max(abs(g[0] - 4.0), abs(g[1] - 4.0)) > 1e-3
    ),
    form="list",
    hint="where are the poles? two of them, and not both at −2",
)

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) A report explains a circle of the flock that is smaller than its target's by the place
# where the flock started. Why can no start explain the radius in the long run, and what can? Answer in your own
# words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# The centre of mass obeys a stable linear equation of second order that is driven by the target. Whatever comes from
# the start is a solution of the homogeneous equation and dies out like its poles, so after a while only the response
# to the target is left. Its size is the modulus of the transfer function at the target's frequency, which depends on
# the gains, the frequency, and the velocity that the target reports.
#
# **Rubric, a point each:** the part due to the start decays with the poles; what remains is the modulus of the
# transfer function at the target's frequency.

# %% [markdown] tags=["exercise"]
# **7.** ★ (1 point, player) Move the slider of the ratio $c_1^\gamma/c_1^\alpha$. Which is the least value on it at
# which agents share a place? (Exactly.)

# %% tags=["answer"]
first_shared = ...

# %% tags=["solution"]
first_shared = next(ratio for ratio in ratios if fl.min_distance(settled[ratio].q) < 1e-6)
print(first_shared)

# %% tags=["check"]
grade(
    first_shared,
    1.2,
    hint="the title gives the distance of the closest pair; a number beside an agent counts those in its place",
)

# %% [markdown] tags=["exercise"]
# **8.** ★★★ (3 points, proof) Let $c_1^\gamma > 0$ and $c_2^\alpha > 0$, but $c_2^\gamma = 0$. (a) Prove that claim
# (i) of Theorem 3 still holds. (b) Which step of the proof of (iii) breaks? (c) Two agents in the plane start on
# opposite sides of a γ-agent at rest in the origin, out of range of each other, and each circles it. Show that (iii)
# fails for them.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# (a) $\dot H_\lambda = -c_2^\alpha v^\top\hat Lv \le 0$ still, so $\tfrac\lambda2\|x_i(t)\|^2 \le H_\lambda(0)$ as
# before. (b) Step 3: $\dot H_\lambda = 0$ now gives equal velocities only among linked agents, and $v = 0$ only if
# the net is connected. (c) Let $q_1 = -q_2 = (R\cos\omega t, R\sin\omega t)$ with $\omega = \sqrt{c_1^\gamma}$ and
# $2R \ge r$. They are never in range, so $u_i = -c_1^\gamma q_i$, which is $-\omega^2q_i = \ddot q_i$: it is a
# solution. Their velocities are opposite at all times and never agree.
#
# **Rubric, a point each:** the energy still falls and bounds the radius; the step that needs $c_2^\gamma > 0$ or a
# connected net; circles of radius $R \ge r/2$ with $\omega^2 = c_1^\gamma$ solve the law.
