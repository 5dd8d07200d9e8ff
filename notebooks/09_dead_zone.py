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
# # Dead-zone potentials and discontinuous forces
#
# **Aims.** Read a force law that jumps, find its potential and the energy that belongs to it, see what a jump does to
# an integrator, and sort a printed theorem into what is true, what is false and what can be mended.
#
# ## A scene
#
# A convoy of robots is told: closer than 3.5 metres, back off; farther than 12.5, catch up; in between, mind your
# own business. It is how people drive. The rule is simple to write into a controller, three cases and an `if`.
# **What does such an `if` do to the motion, to the energy, and to the program that integrates it?** More than its
# author thought: the force jumps, the printed energy jumps too, and a pair of robots can be caught *at* the jump,
# where the law has no value.
#
# ## Two robots at the edge
#
# Let two robots stand just inside 3.5, where they repel. They move apart, cross 3.5, and enter the dead zone, in
# which only a weak pull is left. It brings them back to 3.5, slowly, and there the full repulsion throws them out
# again, in no time. Friction makes each throw shorter, and the switches come faster and faster, without end. Filippov
# (1960) gave this a meaning: at a jump the force may be any mean of its two one-sided values, and the robots take the
# one that keeps them there. A computer that steps in time cannot take a mean; it rattles.
#
# Li, Yuan and Liu (`fl.cite(fl.theorem("dead-zone-1-printed"))`) let agents repel below $d_1 = r_b-\delta$, attract
# above $d_2 = r_b+\delta$, and leave each other alone between. Made definite (errata L1, L2), with $d_{ij} =
# \|q_j-q_i\|$,
#
# $$\begin{gathered}
#   u_i = \sum_{d_{ij} < r} \Bigl[ f(d_{ij})\,\frac{q_j-q_i}{\sqrt{1+\eta d_{ij}^2}}
#   + k_1 (q_j-q_i) + k_2 (p_j-p_i) \Bigr], \\[1ex]
#   f = \begin{cases} -(2k_r/d_{ij}^2 + k_\delta) & d_{ij} < d_1 \\ 0 & d_1 \le d_{ij} \le d_2 \\
#   2k_r/(r_d-d_{ij})^2 + k_\delta & d_2 < d_{ij} < r \end{cases}
# \end{gathered}$$

# %%
import numpy as np
from scipy.integrate import solve_ivp

import flockana as fl
from flockana import plots, symbolic
from flockana.course import Prediction, figures, grade

hard, ramped = fl.DeadZoneInteraction(ramp=0.0), fl.DeadZoneInteraction()
figure, axes = plots.subplots(1, 2, size=(11, 3.4))
plots.dead_zone_force(hard, ax=axes[0])
_ = plots.dead_zone_force(ramped, ax=axes[1])

# %% [markdown]
# **Figure 9.1.** The force of a pair over its distance, below 0 where it repels. Open circles are values beside a
# jump.

# %%
for jump in hard.jumps():
    print(f"at {jump.where:>2} = {jump.distance:4.1f} the force jumps from {jump.below:8.4f} to {jump.above:.4f}")

# %% [markdown]
# On the right a *ramp* of width 0.25 takes the place of the jumps beside the dead zone. The one at $r$ stays.
#
# <details><summary>The first jump by hand</summary>
#
# With $k_r = 200$, $k_\delta = 1.3$, $k_1 = 0.01$, $\eta = 1$, at $d_{ij} = 3.5$:
# just below, $f = -(400/12.25 + 1.3) = -33.95$. The vector $(q_j-q_i)/\sqrt{1+\eta d_{ij}^2}$ has the length
# $3.5/\sqrt{13.25} = 0.9615$, and $k_1$ pulls with $0.035$. Together $-33.95\cdot0.9615 + 0.035 = -32.61$: they repel.
# Just above only the pull is left, $+0.035$.
#
# </details>
#
# Above $d_1$ a thousandth of the repulsion pulls, and yet it is this thousandth that brings the robots back to the
# edge.
#
# ## The potential, in closed form
#
# The source calls $f$ a bounded potential (erratum L3). It is a force, unbounded as $1/d_{ij}^2$. What is its
# potential? The force along the line is $f$ times the length of its vector, so for the repulsion (without $k_\delta$)
#
# $$\psi(x) = 2k_r\Bigl(\operatorname{arsinh}\frac{1}{\sqrt\eta\,x} -
#   \operatorname{arsinh}\frac{1}{\sqrt\eta\,d_1}\Bigr) .$$
#
# <details><summary>In three lines</summary>
#
# $$\begin{aligned}
# F(x) &= -\frac{2k_r}{x^2}\cdot\frac{x}{\sqrt{1+\eta x^2}} = -\frac{2k_r}{x\sqrt{1+\eta x^2}} && \text{force along
#   the line} \\
# \frac{d}{dx}\operatorname{arsinh}\frac{1}{\sqrt\eta\,x} &=
#   \frac{1}{\sqrt{1 + 1/(\eta x^2)}}\cdot\frac{-1}{\sqrt\eta\,x^2}
#   = -\frac{1}{x\sqrt{1+\eta x^2}} && \operatorname{arsinh}'(z) = 1/\sqrt{1+z^2} \\
# \psi(x) &= 2k_r\Bigl(\operatorname{arsinh}\frac{1}{\sqrt\eta\,x} - \operatorname{arsinh}\frac{1}{\sqrt\eta\,d_1}\Bigr)
#   && \psi' = F, \ \psi(d_1) = 0
# \end{aligned}$$
#
# </details>
#
# For small $x$ this grows like $-2k_r\ln x$: without bound, but slowly, because the vector $q_j - q_i$ is short when
# the agents are near. To halve a small distance always costs the same, $2k_r\ln2 = 277$. The library derives all parts,
# those of $k_\delta$, $k_1$ and the attraction included:

# %%
potential = symbolic.dead_zone.derive_potential()
print("residuals:", potential.residuals)
potential

# %% [markdown]
# ## Which energy falls
#
# The source sums $\psi$ over *neighbours*. That sum jumps up by $\psi(r)$ whenever a pair comes into range: just
# outside the pair is not counted, just inside it is. Hold each pair's potential constant beyond $r$ instead,
# and count *all* pairs:
#
# $$\bar H = \tfrac12\sum_i\|p_i\|^2 + \sum_{i<j}\psi\bigl(\min(d_{ij}, r)\bigr).$$
#
# > **Theorem (the energy that falls).** Along every solution of the law whose pairs switch at isolated times, $\bar H$
# > is continuous, and $\dot{\bar H} = -k_2\,p^\top\hat L\,p \le 0$ between the switches. So it never rises (erratum
# > L5).
#
# *Proof.*
#
# 1. $\psi$ is an integral of a bounded function (away from 0), so it is continuous, at $d_1$, $d_2$ and $r$ too:
#    *a force may jump, its potential only has a corner*. Positions and velocities are continuous. So is $\bar H$.
# 2. Between two switches every pair stays in its zone, and everything can be differentiated. With
#    $\dot p_i = u_i$ and $F_{ij}$ the force of the pair along its line,
#
# $$\begin{aligned}
# \dot{\bar H} &= \sum_i\langle p_i, u_i\rangle + \sum_{i<j}F_{ij}\,\dot d_{ij} && \psi' = F \text{ within } r,\ 0
#   \text{ beyond} \\
# \sum_i\langle p_i, u_i\rangle &= \sum_{i<j}\langle p_i - p_j,\; F_{ij}\hat e_{ij} + k_2(p_j - p_i)\rangle && \text{sum
#   over pairs; } \hat e_{ij} \text{ points from } i \text{ to } j \\
# &= -\sum_{i<j}F_{ij}\,\dot d_{ij} - k_2\sum_{i<j,\; d_{ij}<r}\|p_j-p_i\|^2 && \dot d_{ij} = \langle p_j - p_i, \hat
#   e_{ij}\rangle \\
# \dot{\bar H} &= -k_2\,p^\top\hat L\,p . && \text{definition of } L
# \end{aligned}$$
#
# 3. A continuous function that falls on each of the intervals between isolated times falls. $\square$
#
# Where did the printed proof go wrong? It differentiates a sum whose *set of summands* changes, and differentiates the
# summands only. Whoever sums over neighbours has to ask what happens when a neighbour arrives. Sixteen agents:

# %%
run = fl.scenario("dead-zone-flow").run()
figure, axes = plots.subplots(1, 2, size=(11, 3.4))
plots.dead_zone_energies(run.window(0.5, 20.0), ax=axes[0])
_ = plots.energy_residual(run, ax=axes[1])

# %% [markdown]
# **Figure 9.2.** Sixteen agents. Left: the energy over all pairs falls, the printed one over neighbours jumps up
# whenever a pair comes into range. Right: the balance closes to seven digits.
#
# ## What a jump does to an integrator
#
# An adaptive solver assumes that the solution is smooth within a step. Its error estimate is the difference of two
# formulas which agree up to a high power of the step *if the right-hand side has derivatives*. Let a pair cross $d_1$
# at the share $z$ of a step $\Delta t$. Whatever the solver does, it evaluates the force at a few fixed places of the
# step, so it uses the wrong side of the jump for some share $z'$ of the step instead of $z$. Its velocity is off by
#
# $$|z - z'|\cdot\Delta t\cdot\bigl|F(d_1+) - F(d_1-)\bigr|, \qquad \text{here up to } 32.6\,\Delta t .$$
#
# That is an error of the *first* order in the step, for a method of the eighth. To get nine digits the step would have
# to be $10^{-11}$ there, and so the solver fails, halves, fails again, and steps over the jump in the end with an error
# that its estimate has not seen. `fl.simulate` holds every pair in its zone, finds the
# first pair that leaves, stops there, and starts anew. Two agents fly at each other, turn, and part: six switches.

# %%
law = fl.DeadZoneFlocking(hard, k2=0.0)
q0, p0, span = np.array([[0.0, 0.0], [16.0, 0.1]]), np.array([[1.0, 0.0], [-1.0, 0.0]]), (0.0, 30.0)


def raw(t, y):
    q, p = y.reshape(2, 2, 2)
    return np.concatenate([p.ravel(), law.acceleration(t, q, p).ravel()])


exact = fl.simulate(law, q0, p0, span, rtol=1e-12, atol=1e-14).q[-1]
y0 = np.concatenate([q0.ravel(), p0.ravel()])
for rtol in (1e-6, 1e-8, 1e-10):
    stepped = solve_ivp(raw, span, y0, method="DOP853", rtol=rtol, atol=rtol / 100)
    found = fl.simulate(law, q0, p0, span, rtol=rtol, atol=rtol / 100)
    off = [abs(q - exact).max() for q in (stepped.y[:4, -1].reshape(2, 2), found.q[-1])]
    print(f"rtol {rtol:g}: raw {stepped.nfev} evaluations, error {off[0]:.0e}; ", end="")
    print(f"located {found.stats['evaluations']}, {off[1]:.0e}, {found.stats['switches']} switches")

# %% [markdown]
# ## Sliding
#
# Just above $d_1$ the pull $k_1 d_{ij}$ draws two agents together, just below it they repel. Damped, they bounce at
# $d_1$ ever lower, and the switches come ever faster: in the limit the pair is *held at the jump*, a sliding mode in
# Filippov's sense. A solver that locates the switches gives up when they can no longer be told apart, and the run says
# so.

# %%
pair, rest = np.array([[0.0, 0.0], [5.0, 0.0]]), np.zeros((2, 2))
held = fl.simulate(fl.DeadZoneFlocking(hard), pair, rest, (0.0, 80.0))
settled = fl.simulate(fl.DeadZoneFlocking(ramped), pair, rest, (0.0, 80.0))
print(held.message)

figure, axes = plots.subplots(1, 2, size=(11, 3.2))
for ax in axes:
    ax.plot(held.t, np.linalg.norm(held.q[:, 1] - held.q[:, 0], axis=1), label="jumps, located")
    ax.plot(settled.t, np.linalg.norm(settled.q[:, 1] - settled.q[:, 0], axis=1), label="ramp")
    ax.set(xlabel="t (time)", ylabel="distance (length)")
axes[0].legend()
_ = axes[1].set(xlim=(36.0, 50.0), ylim=(3.495, 3.506))

# %% [markdown]
# **Figure 9.3.** A pair that is drawn to $d_1 = 3.5$; right, enlarged. With jumps it bounces ever lower and the run
# ends where it is held; with a ramp it comes to rest.
#
# What does it mean to be held where the law has no value? Let $y$ be the distance and $\ddot y = F(y) - 2k_2\dot y$
# its equation near $d_1$, with $F > 0$ just below $d_1$ (repulsion) and $F < 0$ just above (the pull of $k_1$).
# *Filippov's* definition: at $y = d_1$ the acceleration may be any number between the two one-sided limits
# $F(d_1-) > 0$ and $F(d_1+) < 0$.
#
# > **Theorem (held at the jump).** Let $F \ge f_1 > 0$ for $y$ just below $d_1$ and $F \le -f_2 < 0$ just above, and
# > $k_2 > 0$. Then $y = d_1$, $\dot y = 0$ is an equilibrium in Filippov's sense, and every solution that starts
# > near it converges to it.
#
# *Proof.*
#
# 1. 0 lies between $F(d_1-)$ and $F(d_1+)$, so the constant function $y = d_1$ has an admissible acceleration,
#    namely 0: it is a solution. The share $z$ of the repelling force is fixed by $z\,F(d_1-) + (1-z)\,F(d_1+) = 0$.
# 2. Let $W = \tfrac12\dot y^2 - \int_{d_1}^yF$. Below $d_1$ the second term is at least $f_1\,(d_1 - y)$, above at
#    least $f_2\,(y - d_1)$. So $W > 0$ near the equilibrium except at it, though it has a corner there.
# 3. Where $F$ is continuous, $\dot W = \dot y\,\ddot y - F\dot y = -2k_2\dot y^2 \le 0$. A solution is at $y = d_1$
#    either for single instants, through which $W$ is continuous, or for an interval of time, on which $\dot y = 0$
#    and $W$ is constant. So $W$ never rises, and by Lyapunov's argument (lecture 00a) solutions from near stay near.
# 4. By LaSalle's principle, which holds for Filippov's solutions too, the solution approaches a set on which
#    $\dot y = 0$ for ever. There $y$ is constant and 0 is an admissible acceleration, which it is near $d_1$ at
#    $d_1$ only. $\square$
#
# So the law's motion comes to rest.

# %%
figure, axes = plots.subplots(1, 2, size=(11, 3.6))
_ = figures.held_at_a_jump(axes=axes)

# %% [markdown]
# **Figure 9.4.** Left: the acceleration of a pair near a jump, in round numbers; at the jump itself Filippov allows
# every value of the dashed segment, 0 among them. Right: distance and its rate. Each turn crosses the jump twice, and
# each is smaller than the one before; the turns are wide on the side of the weak pull.
#
# ## How fast the bouncing dies out
#
# Let the pair leave $d_1$ outwards with a small rate $\dot y = v$. Above $d_1$ it
# is slowed down by nearly $f_2$, and returns after about $2v/f_2$. On the way friction takes energy out:
#
# $$\begin{aligned}
# \int 2k_2\,\dot y^2\,dt &\approx 2k_2\int_0^{2v/f_2}(v - f_2t)^2\,dt = \tfrac43k_2\,v^3/f_2 && \text{work of the
#   friction} \\
# \tfrac12v^2 - \tfrac12v'^2 &\approx v\,(v - v'), \quad\text{so}\quad v' - v \approx -\tfrac43k_2\,v^2/f_2 &&
#   \text{it returns with the rate } v' \\
# \frac{v' - v}{2v/f_2} &\approx -\tfrac23k_2\,v , \quad\text{so}\quad \dot v \approx -\tfrac23k_2\,v . &&
#   \text{and below } d_1 \text{ with } f_1 \text{ the same}
# \end{aligned}$$
#
# The two forces have dropped out: however hard the repulsion and however weak the pull, the rate at the jump falls like
# $e^{-2k_2t/3}$. The time between two switches is proportional to $v$, so the *switches come faster and faster, like
# $e^{2k_2t/3}$*. In exact arithmetic the pair switches infinitely often and never quite stops. (A ball that loses a
# fixed *share* of its speed at each bounce stops in a finite time; here the share itself becomes small.) No solver that
# locates the switches one by one gets beyond a certain time, because soon two switches are nearer to each other than
# numbers can tell; and no engineer cares about the difference. Filippov's equilibrium says what is left.

# %%
from scipy.optimize import brentq


def bounce(v, f, k2=1.0):
    """Rate and time of return to the jump, of a pair that leaves it at the rate v against the constant force f."""
    speed = v + f / (2.0 * k2)  # y' = speed exp(-2 k2 t) - f/(2 k2)
    top = np.log(speed * 2.0 * k2 / f) / (2.0 * k2)

    def place(t):
        return speed * (1.0 - np.exp(-2.0 * k2 * t)) / (2.0 * k2) - f / (2.0 * k2) * t

    back = brentq(place, top, 10.0 * top + 2.0 * v / f + 1e-9, xtol=1e-16, rtol=1e-14)
    return f / (2.0 * k2) - speed * np.exp(-2.0 * k2 * back), back


v, t, returns = 0.05, 0.0, []
for _ in range(2000):
    for size in (0.07, 65.2):  # above the jump, then below it
        v, passed = bounce(v, size)
        t += passed
    returns.append((t, v))
returns = np.array(returns)
slope = np.polyfit(returns[500:, 0], np.log(returns[500:, 1]), 1)[0]
print(f"2000 bounces in {t:.1f}; the rate at the jump falls like exp({slope:.3f} t), by hand exp(-0.667 t)")

# %% [markdown]
# ## What a program makes of it
#
# A fixed step sees neither jump nor sliding; it goes on, and chatters (erratum L7). With the ramp the force is
# continuous there, and the pair comes to rest.

# %%
for name in ("chatter", "ramp"):
    print(fl.verify("L7").claim(name).detail)

from flockana.course.picture_slider import film


def stepped(interaction, dt, end=80.0):
    length, rate, found = 3.6, 0.0, []
    for _ in range(round(end / dt)):  # both agents feel the force, and the damping k2 = 1
        rate -= 2.0 * dt * (rate - float(interaction.force(length)))
        length += dt * rate
        found.append(length)
    return dt * np.arange(1, len(found) + 1), np.array(found)


curves = {"jump, steps of 0.05": stepped(hard, 0.05), "jump, steps of 0.01": stepped(hard, 0.01)}
curves["ramp, steps of 0.05"] = stepped(ramped, 0.05)
print(f"with steps of 0.05 a pair at the jump is thrown out to {curves['jump, steps of 0.05'][1].max():.2f}")

# %% tags=["predict"]
guess = ...
Prediction(
    "To which distance is the pair at the jump, 3.5, thrown out with steps of 0.01?",
    guess,
    curves["jump, steps of 0.01"][1].max(),
)

# %% [markdown]
# With the jump every step that ends below $d_1$ throws the pair out, the less far the shorter the step, for ever. *The
# vibration shrinks with the step, and it is there for every step*: the signature of an artefact.
#
# <details><summary>How large it is</summary>
#
# Let the program step by $\Delta t$, first the rate, then the distance with the new rate. The pair falls slowly past
# $d_1$, and one step later feels the whole repulsion for one step: its rate becomes about $2\cdot32.6\,\Delta t =
# 65.2\,\Delta t$. Outside only friction and the weak pull act. With friction alone, $\ddot y = -2k_2\dot y$, it would
# get as far as $\dot y/(2k_2) = 32.6\,\Delta t$. So every throw is shorter than that: 1.63 for $\Delta t = 0.05$, 0.33
# for 0.01, 0.16 for 0.005.
#
# </details>


# %%
def until(ax, end):
    for name, (t, length) in curves.items():
        ax.plot(t[t <= end], length[t <= end], label=name)
    ax.set(xlim=(0.0, 80.0), ylim=(3.2, 5.2), xlabel="t (time)", ylabel="distance (length)")
    ax.legend(loc="upper right")


film(until, np.linspace(2.0, 80.0, 40), name="t", title="the distance of a pair at the jump", seconds=8.0)

# %% tags=["facts"]
late = [length[t > 60.0] for t, length in curves.values()]
assert np.ptp(late[0]) > 2.0 * np.ptp(late[1]) > 0.05
assert np.ptp(late[2]) < 1e-6
assert abs(slope + 2.0 / 3.0) < 5e-3
contact = hard.jumps()[0]
assert abs(contact.below + 32.61) < 0.005
assert abs(contact.above - 0.035) < 1e-9
assert abs((400.0 / 12.25 + 1.3) * 3.5 / 13.25**0.5 - 0.035 - 32.61) < 0.005
for dt in (0.05, 0.01, 0.005):
    t, length = stepped(hard, dt)
    assert 0.02 < length[t > 60.0].max() - hard.d1 < 32.6 * dt
assert abs(2.0 * hard.k_r * np.log(2.0) - 277.0) < 0.5
assert abs(hard.energy(hard.r) - 5.8) < 0.02
by_hand = 400.0 * (np.arcsinh(1.0 / 2.0) - np.arcsinh(1.0 / 3.5))
rest_of_psi = fl.DeadZoneInteraction(ramp=0.0, k_delta=1e-12, k1=1e-12)
assert abs(rest_of_psi.energy(2.0) - by_hand) < 1e-6

# %% [markdown]
# ## The theorem, printed and corrected
#
# > **Theorem 1** (Li, Yuan and Liu, as printed, in our words). From finite initial energy (i) agents form cohesive
# > flocks, in which none is farther than $r$ from its virtual leader; (ii) the energy does not rise, the flock ends
# > in a local minimum of it, and velocities match; (iii) no two agents collide.
#
# Fifty agents in a box of 40, as far as the source says how; and the same in a box of 150:

# %%
near = fl.scenario("dead-zone").run()
wide = fl.scenario("dead-zone-wide-start").run()
print(fl.verify("dead-zone-1-printed", near))
print(fl.verify("dead-zone-1-printed", wide))

# %% [markdown]
# The flock that stays one ends a little wider than $r$, and at rest: it stays so. For the other, a finite run refutes
# "in the end they are together" only if it is certain that they part: by momentum, energy and geometry.
#
# <details><summary>How a finite run speaks of all later times</summary>
#
# 1. *Momentum.* Forces and friction of a pair are opposite, so within a component they cancel in the sum. As long as
#    the component meets nobody, its centre moves at *constant velocity*.
# 2. *Energy.* The component's own $\bar H$, counted in the frame of its centre, does not rise. A pair out of range
#    costs $\psi(r)$, so at most $\bar H/\psi(r)$ of its pairs can ever be out of range. If that is less than the
#    $n_1(n-n_1)$ pairs between two parts, the component cannot split, and its agents stay within $(n-1)r$ of each
#    other.
# 3. *Geometry.* Two components whose centres move apart at constant velocity, and whose agents stay within known
#    distances of the centres, have a gap which grows for ever once it has begun to grow.
#
# So a run need only be continued until the gap of every two components is certain to stay above $r$.
#
# </details>
#
# > **Corrected theorem.** Let each pair's potential be held constant beyond $r$, let $\bar H$ be the sum over all
# > pairs and the kinetic energy, and let no two agents start in one place. Then $\bar H$ is continuous and $\dot{\bar
# > H} = -k_2\,p^\top\hat L\,p \le 0$ across all switches, and no distance ever falls below $d_{\min}$.
#
# Both are proved. With $\bar H(0)$ the energy at the start, a pair inside $d_1$ costs at least
# $2k_r(\operatorname{arsinh}(1/(\sqrt\eta\,d_{ij})) - \operatorname{arsinh}(1/(\sqrt\eta\,d_1)))$, and no two agents
# ever come closer than
#
# $$d_{\min} = \frac{1}{\sqrt\eta\,\sinh\bigl(\bar H(0)/(2k_r)
#   + \operatorname{arsinh}(1/(\sqrt\eta\, d_1))\bigr)} .$$
#
# That velocities match *within* components is seen in this run and not proved:

# %%
print(fl.verify("dead-zone-1-corrected", wide))

# %% tags=["facts"]
H0 = float(wide.energy()[0])
inside = ramped.d1 - ramped.ramp
assert abs(ramped.least_distance(H0) * np.sinh(H0 / (2 * ramped.k_r) + np.arcsinh(1 / inside)) - 1.0) < 1e-9

# %% [markdown]
# ## Where contacts sit
#
# Not at the balance distance $r_b = 8$, but where repulsion ends, at $d_1 = r_b-\delta = 3.5$ (erratum L8): anywhere in
# the dead zone $k_1$ still pulls. With fifty agents in range of each other it pulls hard, and squeezes the middle.

# %%
equilibrium = fl.find_equilibrium(fl.DeadZoneFlocking(), near.q[-1])
print(f"a {equilibrium.kind}, contacts shorter than d1 by at most {equilibrium.strain():.1%}")
contacts = equilibrium.q[fl.links(equilibrium.q, 3.6)]
figure, axes = plots.subplots(1, 2, size=(11, 4.2))
plots.configuration(equilibrium.q, d=ramped.d1, r=3.6, ax=axes[0], bar=False)
axes[1].plot(
    np.linalg.norm(contacts.mean(axis=1) - equilibrium.q.mean(axis=0), axis=1),
    np.linalg.norm(contacts[:, 1] - contacts[:, 0], axis=1),
    "o",
)
axes[1].axhline(ramped.d1, color="black", linestyle=":")
_ = axes[1].set(xlabel="distance of the contact from the centre (length)", ylabel="its length")

# %% [markdown]
# **Figure 9.5.** Contacts, pairs nearer than 3.6, and their lengths: in the middle of the flock they are squeezed below
# $d_1$ (dotted), at its rim hardly.
#
# ## What surprised, and what the corrected theorem does not say
#
# Students usually guess that the jump of the force is the problem and the energy is innocent. It is the other way
# round: a jumping force is harmless for the theory, and the *energy as printed* is what breaks the proof. It differs
# from the one that falls by a constant for each pair, that is switched on and off. The corrected theorem does not
# promise one flock: $\psi(r)$ is finite, so enough speed takes any pair apart. It does not give velocities that match
# in the limit, which is measured here, and it gives a least distance that is true and tiny for realistic energies.
#
# ## Questions that come up
#
# *Does the pair touch $d_1$ or not?* Its distance tends to $d_1$ and crosses it again and again. Filippov's equilibrium
# is the limit, not a state that is reached.
#
# *Why not simply define the force at $d_1$ to be 0?* A single value at a single distance changes nothing: a pair that
# crosses is there for no time. Filippov's definition looks at the values *near* the jump.
#
# *Is the ramp the better law, then?* It is another law, whose pair rests a little off $d_1$, and which a computer
# integrates as usual. A real motor has a ramp anyway.
#
# ## Summary
#
# - A force may jump; its potential has a corner there and is continuous.
# - The potential that is continuous across switches holds each pair's cost constant beyond the range; its sum falls.
# - At a jump an integrator's error estimate means nothing: switches have to be located.
# - A pair can be held at a jump, in Filippov's sense; a fixed step chatters there.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, derivation) Two agents out of range approach each other head-on at relative speed 2 on a line. By
# how much does the printed energy, of neighbours, rise at the instant at which they come into range? The potential of a
# pair is $\psi = \tfrac12k_1d_{ij}^2$ plus the integral of $f$, counted from the dead zone, where it is 0.
# (Default parameters, without a ramp, `hard` of the lecture; four significant digits.)

# %% tags=["answer"]
rise = ...

# %% tags=["solution"]
rise = hard.energy(hard.r)  # whatever the speed

# %% tags=["check"]
grade(rise, 5.81707271, digits=4, hint="what does a pair at the edge of the range cost?")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, design) What is the greatest energy $\bar H(0)$ for which the corrected theorem promises that no
# two agents come closer than 1? (Without a ramp; $\eta = 1$; four significant digits.)

# %% tags=["answer"]
energy = ...

# %% tags=["solution"]
energy = 2 * hard.k_r * (np.arcsinh(1.0) - np.arcsinh(1.0 / hard.d1))

# %% tags=["check"]
grade(energy, 239.764139, digits=4, hint="set the least distance to 1 and solve for the energy")

# %% [markdown] tags=["exercise"]
# **3.** ★★★ (3 points, experiment) Two agents 14 apart leave each other, each at speed $v$, with the default law. At
# which of the speeds 1, 2, 3, 4 do they part for ever? Give a list, in any order.

# %% tags=["answer"]
parting = ...


# %% tags=["solution"]
def cohesion(v):
    leaving = fl.simulate(fl.DeadZoneFlocking(), [[0.0], [14.0]], [[-v], [v]], (0.0, 10.0))
    return fl.verify("dead-zone-1-printed", leaving).claim("cohesion").status


parting = [v for v in (1, 2, 3, 4) if cohesion(v) == "refuted"]

# %% tags=["check"]
grade(parting, {3, 4}, hint="the printed theorem's claim of cohesion says when parting is certain")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, derivation) Filippov: at the jump at $d_1$ a held pair feels a convex combination of the two
# forces beside it, with the share that makes it 0. `hard.jumps()` gives both forces. What share of the repelling one is
# it, to three significant digits?

# %% tags=["answer"]
share = ...

# %% tags=["solution"]
contact = hard.jumps()[0]
share = contact.above / (contact.above - contact.below)

# %% tags=["check"]
grade(share, 0.001072077, digits=3, hint="share × one force + (1 − share) × the other = 0")

# %% [markdown] tags=["exercise"]
# **5.** ★★ (2 points, derivation) What least distance does the corrected theorem guarantee (a) for $\bar H(0) = 100$,
# (b) for $\bar H(0) = 200$, without a ramp and with $\eta = 1$? Give the list, each to four significant digits.

# %% tags=["answer"]
nearest = ...

# %% tags=["solution"]
nearest = [1.0 / np.sinh(H / (2.0 * hard.k_r) + np.arcsinh(1.0 / hard.d1)) for H in (100.0, 200.0)]

# %% tags=["check"]
grade(nearest, [1.79401084, 1.15723845], digits=4, hint="the formula is above; k_r is hard.k_r")

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) A fixed-step simulation of a pair at $d_1$ shows a small vibration that never ends. How
# would you find out whether the vibration belongs to the law or to the integrator, and which is it here? Answer in
# your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Halve the step: the amplitude of what the integrator makes shrinks with the step and its frequency grows, while a
# motion of the law stays. Locating the switches, or a ramp in the place of the jump, shows the same. Here the
# vibration is the integrator's: in Filippov's sense the pair is held at the jump, and with the ramp it comes to rest.
#
# **Rubric, a point each:** a test that separates the two: the step, located switches, or a ramp; it is the
# integrator's, as the law holds the pair at the jump.


# %% [markdown] tags=["exercise"]
# **7.** ★ (1 point, player) Play the film of the pair at the jump. How many times is the pair with steps of 0.01 thrown
# out until $t = 80$? (A whole number.)

# %% tags=["answer"]
throws = ...

# %% tags=["solution"]
throws = np.sum(np.diff((curves["jump, steps of 0.01"][1] < hard.d1).astype(int)) == 1)
print(throws)

# %% tags=["check"]
grade(throws, 9, hint="count the turns at 3.5 of the curve with the shorter steps")

# %% [markdown] tags=["exercise"]
# **8.** ★★★ (3 points, proof) Let no pair have a negative potential, and let $\bar H$ never rise. (a) Derive the bound
# $d_{\min}$ of the corrected theorem from the potential $\psi$ that the lecture has computed. (b) Prove: a flock whose
# net is connected at the start and which has $\bar H(0) < (n-1)\,\psi(r)$ stays connected at all times. (c) Why is (b)
# of little use for two fast robots, and the printed claim of cohesion false?

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# (a) A pair inside $d_1$ costs at least $\psi(d_{ij}) = 2k_r\bigl(\operatorname{arsinh}(1/(\sqrt\eta\,d_{ij})) -
# \operatorname{arsinh}(1/(\sqrt\eta\,d_1))\bigr)$; $k_\delta$ only adds to it. All other terms of $\bar H$ are not
# negative and $\bar H \le \bar H(0)$, so this is at most $\bar H(0)$ at every time. Solve for $d_{ij}$:
# $1/(\sqrt\eta\,d_{ij}) \le \sinh(\bar H(0)/(2k_r) + \operatorname{arsinh}(1/(\sqrt\eta\,d_1)))$, that is $d_{ij} \ge
# d_{\min}$. (b) Suppose that at some time the net falls into parts of $n_1$ and $n - n_1$ agents. Then $n_1(n-n_1) \ge
# n - 1$ pairs are out of range, each costs $\psi(r)$, and $\bar H \ge (n-1)\psi(r) > \bar H(0)$ at that time, against
# $\bar H \le \bar H(0)$. (c) For $n = 2$ the condition is $\bar H(0) < \psi(r)$, 5.8 with the parameters of the
# lecture, kinetic energy included: robots that leave each other faster have more, and part. The printed claim has no
# condition on the energy but that it is finite.
#
# **Rubric, a point each:** one pair's cost is at most $\bar H(0)$, solved for the distance; the count of pairs between
# the parts; the case of two with a number.
