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
# # σ-norm, bumps and pair potentials
#
# **Aims.** Build the force with which two agents keep their distance, part by part; derive its potential; know which
# of its properties are proved, which are computed and to what accuracy, and where a formula loses digits.
#
# ## A scene
#
# Three hundred drones form a picture in the night sky. Two of them drift towards each other. Their computers know
# the vector between them and nothing else, and have to answer with a force. **What should that force be, as a
# function of the distance?** Nearer than $d$ it must push, farther it must pull, at $d$ it must vanish. Out of radio
# range it must be zero, and it must not jump to zero there, because a thrust that jumps breaks motors and, as we
# shall see, integrators. When the two are in one place, it must not be infinite. This lecture builds such a force, the
# one of Olfati-Saber (2006, section II), and with it the potential that every later lecture uses.
#
# ## Two agents on a line: a first try
#
# Let $x > 0$ be the distance of two agents. The simplest force is a spring, $x - d$, cut off at the range $r$. It
# has two faults. At $r$ it jumps from $r - d$ to 0, which neither a motor nor an integrator follows (lecture 09). And
# in the plane the spring acts along the unit vector $(q_j - q_i)/\|q_j - q_i\|$, which has no limit where the
# agents meet: the force on an agent that flies past another at a hair's breadth turns around in no time. Both faults
# are repaired by smoothing: the second by a norm without a corner, the first by a bump.
#
# ## A norm without a corner
#
# For a vector $z$ and a number $\varepsilon > 0$ let
#
# $$\|z\|_\sigma = \frac{1}{\varepsilon}\left(\sqrt{1 + \varepsilon \|z\|^2} - 1\right).$$
#
# Its gradient, by the chain rule, is $z/\sqrt{1+\varepsilon\|z\|^2}$.
#
# <details><summary>In two lines</summary>
#
# $$\begin{aligned}
# \nabla\|z\|_\sigma &=
#   \frac1\varepsilon\cdot\frac{1}{2\sqrt{1+\varepsilon\|z\|^2}}\cdot\nabla\bigl(\varepsilon\|z\|^2\bigr)
#   && \text{derivative of the root} \\
# &= \frac1\varepsilon\cdot\frac{2\varepsilon z}{2\sqrt{1+\varepsilon\|z\|^2}} =
#   \frac{z}{\sqrt{1+\varepsilon\|z\|^2}} . && \nabla\|z\|^2 = 2z
# \end{aligned}$$
#
# </details>
#
# The denominator is at least 1, so the gradient exists everywhere and is smooth, at $z = 0$ too, where it is 0. The
# gradient at $z = q_j - q_i$ is the vector with which all forces of this course act,
#
# $$n_{ij} = \frac{q_j - q_i}{\sqrt{1 + \varepsilon\|q_j - q_i\|^2}} .$$
#
# It points from $i$ to $j$, and its length grows from 0 to $1/\sqrt\varepsilon$.

# %%
import numpy as np
import sympy as sp

import flockana as fl
from flockana import plots, symbolic
from flockana.course import Prediction, figures, grade

figure, axes = plots.subplots(1, 2, size=(10, 3.6))
_ = figures.pair_vector(eps=0.1, axes=axes)

# %% [markdown]
# **Figure 1.1.** Left: the vector $n_{ij}$ (solid) has the direction of $q_j - q_i$ (dashed) and is shorter. Right:
# its length, for $\varepsilon = 0.1$. It vanishes smoothly where two agents coincide and never exceeds
# $1/\sqrt\varepsilon = 3.16$.

# %%
figure, ax = plots.subplots(size=(5.4, 3.6))
_ = figures.norms(ax=ax)

# %% [markdown]
# **Figure 1.2.** On a line the Euclidean norm is $|x|$, with a corner at 0. The σ-norms are parabolas near 0 and
# straight lines far out.
#
# For small $\|z\|$ the root is about $1 + \tfrac12\varepsilon\|z\|^2$, so $\|z\|_\sigma \approx \tfrac12\|z\|^2$. For
# large $\|z\|$ the 1 under the root does not count, and $\|z\|_\sigma \approx \|z\|/\sqrt\varepsilon$. With
# $\varepsilon = 0.1$ the change-over is at $1/\sqrt\varepsilon = 3.2$: the σ-norm of 0.1 is 0.0050, half the square;
# that of 100 is 306, not far from $100/\sqrt{0.1} = 316$. Despite its name the σ-norm is no norm: twice the vector has
# not twice the σ-norm. It is a strictly increasing function of $\|z\|$, and that is all that is needed: "nearer than
# $d$" is the same as "σ-norm below $d_\alpha$" with $d_\alpha = \|d\|_\sigma$, and likewise $r_\alpha = \|r\|_\sigma$.
#
# ## A bump
#
# A weight that is 1 near an agent, 0 at the edge of its range and smooth between is the *bump function*, for
# $0 < h < 1$,
#
# $$\rho_h(z) = \begin{cases} 1 & 0 \le z < h \\ \tfrac12\bigl[1 + \cos\bigl(\pi\tfrac{z-h}{1-h}\bigr)\bigr] & h \le
#   z \le 1 \\ 0 & z > 1 . \end{cases}$$
#
# It is once continuously differentiable and no more, which integrators will notice.
#
# <details><summary>Where the pieces meet</summary>
#
# On the taper its derivative is
# $-\tfrac{\pi}{2(1-h)}\sin\bigl(\pi\tfrac{z-h}{1-h}\bigr)$, which is 0 at $z = h$, because $\sin 0 = 0$, and at
# $z = 1$, because $\sin\pi = 0$. So both derivatives agree on both sides. The *second* derivative does not: at $h$
# it jumps from 0 to $-\tfrac{\pi^2}{2(1-h)^2}$.
#
# </details>

# %%
figure, ax = plots.subplots(size=(5.4, 3.4))
_ = figures.bumps(ax=ax)

# %% [markdown]
# **Figure 1.3.** Three bump functions; a dot marks the end of the plateau. The larger $h$, the steeper the taper.
#
# The weight of the link between two agents is $a_{ij} = \rho_h(\|q_j - q_i\|_\sigma/r_\alpha)$.
#
# ## The action
#
# Now the force. Take a curve through 0 that rises from $-b$ to $a$, with $0 < a \le b$: repulsion may be stronger
# than attraction. With the sigmoid $\sigma_1(z) = z/\sqrt{1+z^2}$, which rises from $-1$ to 1, put
#
# $$\phi(z) = \tfrac12\left[(a+b)\,\sigma_1(z+c) + (a-b)\right], \qquad c = \frac{b-a}{\sqrt{4ab}} .$$
#
# With this $c$ the curve passes through 0.
#
# <details><summary>Why</summary>
#
# $$\begin{aligned}
# 1 + c^2 &= \frac{4ab + (b-a)^2}{4ab} = \frac{(a+b)^2}{4ab} && \text{one denominator} \\
# \sigma_1(c) &= \frac{c}{\sqrt{1+c^2}} = \frac{b-a}{\sqrt{4ab}}\cdot\frac{\sqrt{4ab}}{a+b} = \frac{b-a}{a+b} &&
#   \text{definition of } \sigma_1 \\
# \phi(0) &= \tfrac12\left[(a+b)\,\tfrac{b-a}{a+b} + (a-b)\right] = 0 . && \text{insert}
# \end{aligned}$$
#
# Without $a \le b$ the printed formula $c = |a-b|/\sqrt{4ab}$ would have the wrong sign, and the balance would not
# be at $d$.
#
# </details>
#
# As $\sigma_1' = (1+z^2)^{-3/2} > 0$, $\phi$ rises strictly, so 0 is its only zero. Shift the zero to
# $d_\alpha$, and cut the curve off with the bump:
#
# $$\phi_\alpha(z) = \rho_h(z/r_\alpha)\,\phi(z - d_\alpha) .$$
#
# This is the *action* of a pair: negative (a push) below $d_\alpha$, positive (a pull) between $d_\alpha$ and
# $r_\alpha$, zero from $r_\alpha$ on. The force on agent $i$ is $\phi_\alpha(\|q_j - q_i\|_\sigma)\,n_{ij}$.
#
# ## The potential
#
# A force that depends on a distance only is the slope of a potential. Let
#
# $$\psi_\alpha(z) = \int_{d_\alpha}^z \phi_\alpha .$$
#
# > **Theorem (pair potential).** (i) $\psi_\alpha \ge 0$, with equality on $[0, r_\alpha]$ only at $d_\alpha$. (ii)
# > $\psi_\alpha(z) = \psi_\alpha(r_\alpha)$ for all $z \ge r_\alpha$. (iii) $\psi_\alpha$ is twice continuously
# > differentiable. (iv) The force on agent $i$ is minus the gradient of $\psi_\alpha(\|q_j-q_i\|_\sigma)$ with
# > respect to $q_i$.
#
# *Proof.*
#
# 1. $\phi_\alpha$ is negative on $[0, d_\alpha)$ and positive on $(d_\alpha, r_\alpha)$, as both factors say. So its
#    integral from $d_\alpha$ is positive on both sides of $d_\alpha$: (i).
# 2. Beyond $r_\alpha$ the integrand is 0: (ii).
# 3. $\rho_h$ and $\phi$ are once continuously differentiable, so their product $\phi_\alpha = \psi_\alpha'$ is:
#    (iii).
# 4. By the chain rule $\nabla_{q_i}\psi_\alpha(\|q_j-q_i\|_\sigma) =
#    \phi_\alpha(\|q_j-q_i\|_\sigma)\cdot\nabla_{q_i}\|q_j-q_i\|_\sigma$, and
#    $\nabla_{q_i}\|q_j-q_i\|_\sigma = -n_{ij}$, because $q_i$ stands there with a minus sign: (iv). $\square$
#
# <details><summary>Closed form</summary>
#
# Where the bump is 1, an antiderivative of $\phi$ is $\tfrac12\bigl[(a+b)\sqrt{1+(z+c)^2} + (a-b)z\bigr]$:
# differentiate it, $\tfrac{d}{dz}\sqrt{1+(z+c)^2} = \sigma_1(z+c)$. On the taper the integrand is a cosine times a
# root, and there is no elementary antiderivative; the library integrates it to $10^{-13} c^*$.
#
# </details>
#
# sympy integrates it step by step:

# %%
symbolic.derive_psi_alpha()

# %% [markdown]
# Here are the numbers of the paper's flocks, which most lectures use: $d = 7$, $r = 8.4$, $\varepsilon = 0.1$,
# $h = 0.2$, $a = b = 5$.

# %%
alpha = fl.AlphaInteraction(d=7.0, r=8.4, eps=0.1, h=0.2, a=5.0, b=5.0)
figure, axes = plots.subplots(1, 2, size=(10, 3.8))
plots.action(alpha, ax=axes[0])
_ = figures.wall_and_well(alpha, ax=axes[1])
print(f"d_α = {alpha.d_alpha:.6f}, r_α = {alpha.r_alpha:.6f}, c* = ψ_α(0) = {alpha.c_star:.6f}")
print(f"ψ_α(r_α) = {alpha.psi_alpha(alpha.r_alpha):.6f}: what two agents out of range cost, each pair of them")

# %% [markdown]
# **Figure 1.4.** Left: the action over the distance. Right: the potential, and in the inset the well about $d = 7$,
# enlarged. Pulling a pair apart costs 0.74, pushing it together 52.4.

# %% tags=["predict"]
guess = ...
Prediction(
    "At 8 a pair attracts each other, at 6 it repels. How many times the pull at 8 is the push at 6?",
    guess,
    -np.divide(*(float(alpha.phi_alpha(alpha.sigma_norm(x))) * x / np.sqrt(1.0 + 0.1 * x**2) for x in (6.0, 8.0))),
)

# %% [markdown]
# <details><summary>Both forces by hand</summary>
#
# Let two agents be 8 apart, between $d$ and $r$. Go through the formulas in order:
#
# | what | formula | value |
# |---|---|---|
# | σ-norm of the distance | $(\sqrt{1 + 0.1\cdot64} - 1)/0.1$ | 17.203 |
# | those of $d$ and $r$ | $d_\alpha$, $r_\alpha$ | 14.290, 18.383 |
# | place on the taper | $(17.203/18.383 - 0.2)/0.8$ | 0.920 |
# | bump | $\tfrac12(1 + \cos(0.920\,\pi))$ | 0.0158 |
# | action without bump | $5\,\sigma_1(17.203 - 14.290) = 5\cdot2.913/3.080$ | 4.729 |
# | action | $0.0158\cdot4.729$ | 0.0747 |
# | length of $n_{ij}$ | $8/\sqrt{7.4}$ | 2.941 |
# | force | $0.0747\cdot2.941$ | 0.220 |
#
# The agents attract each other, as they should. At 95 % of the range the bump has taken 98 % of the force away. Now do
# it for 6, where $\phi_\alpha = -2.148$ and the force is $-6.01$: *the push at 6 is 27 times the pull at 8.*
#
# </details>
#
# Whoever draws $\phi$ without the bump expects a strong hold at the rim of the range; there is next to none. The pair
# is a hard wall with a soft leash, and most of what flocks do wrong in this course comes from the leash.
#
# <details><summary>Both potentials in the head</summary>
#
# From $d_\alpha = 14.29$ to $r_\alpha = 18.38$ it is 4.09, and the rim is 0.736
# high, so the mean pull is $0.736/4.09 = 0.18$. From 0 to $d_\alpha$ it is 14.29, and the wall is 52.4 high, so the
# mean push is 3.7, of at most 5. That is how an uneven pair comes from an even $\phi$, with $a = b$: both sides have
# the same strength 5, but the bump weakens the pull, which comes last, and hardly the push.
#
# </details>
#
# The two numbers of the figure have names. $c^* = \psi_\alpha(0)$ is what two coincident agents cost; theorems on
# collisions compare the energy with it. $\psi_\alpha(r_\alpha)$ is what a pair out of range costs, *every* pair out
# of range, however far apart. That constant looks harmless. It makes flocks fall apart (lecture 02) and bounds void
# (lecture 07).
#
# Not every parameter gives such a picture. Move $h$: the larger the plateau of the bump, the less it weakens the
# attraction, and the higher the rim.

# %%
from flockana.course.picture_slider import slider


def with_plateau(ax, h):
    figures.wall_and_well(fl.AlphaInteraction(h=h), ax=ax)


slider(with_plateau, np.round(np.arange(0.1, 0.95, 0.1), 1), name="h", title="potential of a pair", size=(5.4, 3.8))

# %% [markdown]
# ## Why not the deviation energy itself?
#
# A *lattice* is a configuration whose links all have the length $d$ (lecture 04). The *deviation energy* $E(q)$, a
# mean of $(\|q_j - q_i\| - d)^2$ over the links, measures how far a configuration is from one. Why not descend $E$?
# Because $E$ is no potential: it jumps when a pair comes into range, for the new link has the deviation $r - d$; and
# it has a corner where two agents coincide. The *collective potential* $V$, the sum of $\psi_\alpha$ over all pairs,
# has a continuous gradient at both, by (iii) of the theorem.

# %%
_ = plots.deviation(alpha)

# %% [markdown]
# **Figure 1.5.** A pair's deviation energy and its potential over the distance, each relative to its value at 0. To
# the left of 0 one agent has passed through the other.
#
# ## Three routes to one number
#
# How do you know that a number is right? Compute it in ways that share nothing. The compiled kernel, sympy's
# expression with 17 digits, and plain quadrature of $\phi_\alpha$:

# %%
from scipy.integrate import quad

z = 5.0
paper = symbolic.AlphaSymbols(eps=0.1, h=0.2, a=5, b=5, d=7, r=8.4)
print(f"kernel      {alpha.psi_alpha(z):.13f}")
print(f"symbolic    {symbolic.psi_alpha(sp.Integer(5), alpha=paper).evalf(17):.13f}")
print(f"quadrature  {quad(alpha.phi_alpha, alpha.d_alpha, z, epsabs=0.0, epsrel=1e-13)[0]:.13f}")

# %% tags=["facts"]
exact = float(symbolic.psi_alpha(sp.Integer(5), alpha=paper).evalf(17))
assert abs(alpha.psi_alpha(z) - exact) < 1e-12
assert abs(quad(alpha.phi_alpha, alpha.d_alpha, z, epsabs=0.0, epsrel=1e-13)[0] - exact) < 1e-12
assert f"{alpha.c_star:.1f} {alpha.psi_alpha(alpha.r_alpha):.2f} {0.1**-0.5:.2f}" == "52.4 0.74 3.16"
assert abs(alpha.sigma_norm(1e-3) / 0.5e-6 - 1.0) < 1e-6
assert f"{float(alpha.sigma_norm(0.1)):.4f} {float(alpha.sigma_norm(100.0)):.0f}" == "0.0050 306"
means = [alpha.psi_alpha(alpha.r_alpha) / (alpha.r_alpha - alpha.d_alpha), alpha.c_star / alpha.d_alpha]
assert f"{alpha.r_alpha - alpha.d_alpha:.2f} {means[0]:.2f} {means[1]:.1f}" == "4.09 0.18 3.7"
assert f"{float(alpha.phi_alpha(alpha.sigma_norm(np.linspace(7.0, 8.4, 2001))).max()) / 5.0:.0%}" == "7%"
at = float(alpha.sigma_norm(8.0))
assert f"{at:.3f} {alpha.d_alpha:.3f} {alpha.r_alpha:.3f}" == "17.203 14.290 18.383"
assert f"{(at / alpha.r_alpha - 0.2) / 0.8:.3f} {float(alpha.bump(at / alpha.r_alpha)):.4f}" == "0.920 0.0158"
pair_force = [float(alpha.phi_alpha(alpha.sigma_norm(x))) * x / np.sqrt(1.0 + 0.1 * x**2) for x in (8.0, 6.0)]
assert f"{float(alpha.phi_alpha(at)):.4f} {pair_force[0]:.3f} {pair_force[1]:.2f}" == "0.0747 0.220 -6.01"
assert f"{-pair_force[1] / pair_force[0]:.0f}" == "27"
assert f"{2.0 * np.sqrt(alpha.c_star - alpha.psi_alpha(alpha.r_alpha)):.1f}" == "14.4"
assert abs(alpha.sigma_norm(4.3474) - 7.0) < 1e-4
in_centimetres = fl.AlphaInteraction(d=700.0, r=840.0, eps=0.1e-4, h=0.2, a=5.0, b=5.0)
ratios = [
    float(in_centimetres.phi_alpha(in_centimetres.sigma_norm(100.0 * x)) / alpha.phi_alpha(alpha.sigma_norm(x))) * 100.0
    for x in (3.0, 6.9, 8.0)
]
assert [f"{ratio:.1f}" for ratio in ratios] == ["100.5", "361.5", "105.7"]

# %% [markdown]
# ## Digits that disappear
#
# For two agents $10^{-9}$ apart, $\sqrt{1+\varepsilon x^2}-1$ is a difference of two equal numbers: a double carries
# 16 digits, and $\varepsilon x^2 = 10^{-19}$ is lost when 1 is added. Multiply numerator and denominator by
# $\sqrt{1+\varepsilon x^2}+1$:
#
# $$\frac{1}{\varepsilon}\bigl(\sqrt{1+\varepsilon x^2}-1\bigr) = \frac1\varepsilon\cdot\frac{(1+\varepsilon x^2) -
#   1}{\sqrt{1+\varepsilon x^2}+1} = \frac{x^2}{\sqrt{1+\varepsilon x^2}+1} .$$
#
# The right side has no difference in it, and loses nothing.

# %%
tiny = 1e-9
print(f"as printed {(np.sqrt(1 + 0.1 * tiny**2) - 1) / 0.1:.3e},  as computed {alpha.sigma_norm(tiny):.3e}")

# %% [markdown]
# ## What each parameter does
#
# Six numbers make a pair. It is worth knowing which knob does what before turning one.
#
# | parameter | what it does | too small | too large |
# |---|---|---|---|
# | $d$ | distance to keep | – | – |
# | $r$ | how far an agent sees | no attraction, below $d$ | second neighbours in range (lecture 04) |
# | $\varepsilon$ | turns parabola into line, at $1/\sqrt\varepsilon$ | forces grow like a spring | weak forces |
# | $h$ | length of the bump's plateau | weak attraction | steep taper, stiff equation |
# | $a$, $b$ | strongest pull and push | – | all energies and stiffnesses grow in proportion |
#
# The last line is exact for $a = b$: then $c = 0$ and $\phi(z) = a\,\sigma_1(z)$, so $\phi_\alpha$, $\psi_\alpha$
# and $c^*$ are all proportional to $a$ (exercise 6).
#
# **Units.** $\varepsilon$ is one over a length squared. To go from metres to centimetres one would multiply $d$ and $r$
# by 100 and divide $\varepsilon$ by $10^4$. All σ-norms are then $10^4$ times as large, but the 1 under the root of
# $\sigma_1(z) = z/\sqrt{1+z^2}$ stays 1: it has a unit, too, and no parameter to carry it. So this is still another
# law. Were it the same, all forces would be 100 times as large; they are 100.5, 361.5 and 105.7 times as large at 3,
# 6.9 and 8 m. The law as printed is tied to its unit of length.
#
# ## A collision in slow motion
#
# What happens when two agents do meet? The force is finite, so with enough speed they go through each other. Does the
# law survive that? By the theorem it is once continuously differentiable in all positions, coincident ones too, so a
# unique solution goes on. Shoot two agents at each other on a line, and twice more a little off the line. How fast, so
# that they get over the wall? In the frame of their middle each has half the relative speed, so a relative speed $v$ is
# the kinetic energy $2\cdot\tfrac12(\tfrac12v)^2 = \tfrac14v^2$. From out of range, where the pair costs 0.74, they
# reach the top of the wall if $\tfrac14v^2 + 0.74 > 52.4$, that is if $v > 14.4$. Each of ours has the speed 8, so $v =
# 16$ and the energy is $64 + 0.7 = 64.7$:

# %%
meeting = {}
for offset in (0.0, 0.02, 0.1):
    start = np.array([[0.0, 0.0], [12.0, offset]])
    speed = np.array([[8.0, 0.0], [-8.0, 0.0]])
    gains = fl.Gains(c1_alpha=1.0, c2_alpha=1e-6)
    meeting[offset] = fl.simulate(
        fl.Algorithm1(alpha, gains), start, speed, (0.0, 2.0), t_eval=np.linspace(0.0, 2.0, 401)
    )
figure, axes = plots.subplots(1, 2, size=(10, 3.4))
for (offset, run), dash in zip(meeting.items(), ("-", "--", ":"), strict=True):
    axes[0].plot(run.t, run.q[:, 0, 1], dash, label=f"{offset} off the line")
    axes[1].plot(run.t, np.linalg.norm(run.p[:, 0] - run.p[:, 1], axis=1), dash, label=f"{offset} off the line")
axes[0].set(xlabel="time", ylabel="y of the first agent (length)")
axes[1].set(xlabel="time", ylabel="relative speed (length/time)")
_ = axes[0].legend()

# %% tags=["facts"]
energy = alpha.psi_alpha(alpha.sigma_norm(12.0)) + 16.0**2 / 4.0
slowest = np.linalg.norm(meeting[0.0].p[:, 0] - meeting[0.0].p[:, 1], axis=1).min()
assert energy > alpha.c_star  # more than the wall
assert abs(slowest - 2.0 * np.sqrt(energy - alpha.c_star)) < 0.05
aside = [meeting[offset].q[-1, 0, 1] for offset in (0.02, 0.1)]
assert abs(aside[1] / aside[0] - 5.0) < 0.1
assert abs(aside[1] + 1.19) < 0.01

# %% [markdown]
# **Figure 1.6.** Two agents pass through each other (solid) and past each other, 0.02 and 0.1 off the line. Left:
# how far the first agent is turned aside. Right: far out their relative speed is 16, at the wall's top it has fallen
# to $2\sqrt{16^2/4 + 0.7 - 52.4} = 7.0$, and it rises again. The deflection at the end is in proportion to the
# offset, 0.24 and 1.19: nothing singular happens at the meeting.
#
# With a unit vector in the place of $n_{ij}$ there would be no such proportion: the smallest offset would be enough
# to turn the force around at the meeting, and a solver would stumble there. The smooth vector makes the wall a hill
# that one can climb and pass, and the question "do agents collide?" a question about energy. Energies answer it in
# lecture 02: below $c^*$ nobody gets over the hill.

# %% [markdown]
# ## Questions that come up
#
# *Why not a potential that is infinite where two agents coincide? Then they could never collide.* True, and such laws
# exist. The price is a force without bound. A motor has one, and so has a solver's patience: near the pole
# the steps become tiny. With a finite wall "no collision" is a matter of energy, and one has to check it.
#
# *Why is the force $\phi_\alpha n_{ij}$ and not $\psi_\alpha'$ along a unit vector?* It is the same kind of thing,
# written in the σ-norm. The potential is a function of $\|q_j-q_i\|_\sigma$, and the chain rule brings the gradient of
# the σ-norm with it, which is $n_{ij}$. Along the unit vector the force is $\phi_\alpha$ times the length of $n_{ij}$.
#
# *Why shift $\phi$ to $d_\alpha$, and not to $d$?* Because $\phi_\alpha$ takes σ-norms. With $\phi(z - d)$ the force
# would vanish where the σ-norm of the distance is 7, that is at the distance $4.35$: agents would keep that. Whoever
# programs the law from the paper should print the distance at which the force changes its sign; it is the quickest
# test.
#
# *In which unit is a force measured here?* All agents have the mass 1, so a force is an acceleration, length/time$^2$,
# and an energy is length$^2$/time$^2$. The gains of lecture 02 carry what is needed to make $\phi_\alpha
# n_{ij}$ one.
#
# *What is a potential good for, if agents only ever compute forces?* For proofs. A force says what happens next; the
# potential says what can ever happen, without solving an equation. If the sum of potential and kinetic energy never
# rises, whatever costs more than there is at the start is excluded for all times. That is how each theorem of lectures
# 02, 03 and 05 begins.
#
# *Is $d$ the distance at which agents come to rest?* For a pair, yes. In a crowd, no: each agent feels all agents
# within $r$, and only if all those pairs can be at $d$ at once is that a rest. Lecture 04 asks when they can.
#
# *Why once continuously differentiable, and not smooth?* It is enough for the theorems: solutions are unique if the
# force is Lipschitz. A smooth bump can be made from $e^{-1/z}$; the cosine is simpler. Integrators of high order notice
# the kink in $\phi_\alpha'$ and take a smaller step there.
#
# ## What surprised, and what the theorem does not say
#
# The strongest pull is not at the range, and not in the middle of the attracting zone: the bump has weakened it to 7
# % of $a$ before $\phi$ has risen (exercise 4). A link at the length $d$ lies far out on the taper, where the bump
# is only 0.18, so it is much softer than $\phi'(0) = 5$ suggests (exercise 5). And the theorem speaks of one pair.
# Of a sum over pairs it says nothing: three agents in a triangle can all have the length $d$, but four in a square
# cannot have all six.
#
# ## Summary
#
# - The force of a pair is $\phi_\alpha n_{ij}$: an asymmetric sigmoid times the bump function, along a vector that
#   vanishes smoothly where two agents coincide.
# - The potential $\psi_\alpha$ has its minimum at $d$, a high wall $c^*$ at 0, and a shallow rim at $r$, beyond
#   which it is constant.
# - On the bump's plateau it has a closed form, on the taper none.
# - Formulas that subtract nearly equal numbers lose digits; rearranged, they do not.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★★ (2 points, derivation) Let $a = 1$, $b = 5$. (a) What is $c$? (b) What is $\phi(0)$ if $c$ is left out of
# the formula? (c) And what does $\phi(z)$ tend to as $z \to -\infty$? Give the list of the three numbers, each to
# four significant digits.

# %% tags=["answer"]
sigmoid = ...

# %% tags=["solution"]
sigmoid = [4.0 / np.sqrt(20.0), 0.5 * ((1 + 5) * 0 + (1 - 5)), -5.0]

# %% tags=["check"]
grade(sigmoid, [0.894427191, -2.0, -5.0], digits=4, hint="which terms of φ are left at z = 0, and where σ₁ = −1?")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, experiment) A lattice link costs nothing and a pair out of range costs
# $\psi_\alpha(r_\alpha)$. How many pairs out of range weigh as much as one coincident pair, for `alpha`? (Three
# significant digits.)

# %% tags=["answer"]
pairs = ...

# %% tags=["solution"]
pairs = alpha.c_star / alpha.psi_alpha(alpha.r_alpha)

# %% tags=["check"]
grade(pairs, 71.183219, digits=3, hint="both potentials are printed above")

# %% [markdown] tags=["exercise"]
# **3.** ★ (1 point, reading) At $h = 1$ the bump is an indicator, which the slides call "still differentiable". Ask
# erratum E10 and give the height of the jump, exactly.

# %% tags=["answer"]
jump = ...

# %% tags=["solution"]
print(fl.verify("E10"))
jump = 1.0

# %% tags=["check"]
grade(jump, 1.0, hint="one-sided limits at z = 1")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, experiment) At which distance of the pair (a) is the action $\phi_\alpha$ largest, and (b) is
# the force $\|\phi_\alpha n_{ij}\|$ strongest among the attracting ones, for `alpha`? They are not the same. Give
# the list of both, each to four significant digits.

# %% tags=["answer"]
strongest = ...

# %% tags=["solution"]
fine = np.linspace(alpha.d, alpha.r, 2_000_001)
pull = alpha.phi_alpha(alpha.sigma_norm(fine))
strongest = [fine[np.argmax(pull)], fine[np.argmax(pull * fine / np.sqrt(1.0 + 0.1 * fine**2))]]

# %% tags=["check"]
grade(strongest, [7.3139591, 7.3157056], digits=4, hint="maximise between d and r, on a grid that is fine enough")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, derivation) Derive the stiffness of a link: what is $\phi_\alpha'(d_\alpha)$ for `alpha`?
# (Four significant digits; mind that $d_\alpha$ is on the taper of the bump.)

# %% tags=["answer"]
slope = ...

# %% tags=["solution"]
slope = 5.0 * 0.5 * (1.0 + np.cos(np.pi * (alpha.d_alpha / alpha.r_alpha - 0.2) / 0.8))  # φ(0) = 0 kills the other term

# %% tags=["check"]
grade(slope, 0.896325033, digits=4, hint="product rule; one of the two terms vanishes at d_α")

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, design) Let $a = b$. Which value of $a$ makes a coincident pair cost $c^* = 1000$, with
# everything else as in `alpha`? (How does $\phi$ depend on $a = b$? Four significant digits.)

# %% tags=["answer"]
strength = ...

# %% tags=["solution"]
strength = 5.0 * 1000.0 / alpha.c_star  # with a = b, φ is a σ₁: all energies are proportional to a
print(fl.AlphaInteraction(d=7.0, r=8.4, eps=0.1, h=0.2, a=strength, b=strength).c_star)

# %% tags=["check"]
grade(strength, 95.449335, digits=4, hint="what is c for a = b, and what is left of φ?")

# %% [markdown] tags=["exercise"]
# **7.** ★★ (2 points, words) $n_{ij} = (q_j - q_i)/\sqrt{1 + \varepsilon\|q_j - q_i\|^2}$ is shorter than a unit
# vector. What does that do to the force between two agents that come very near each other, and what would go wrong
# with a unit vector in its place? Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Where two agents coincide the vector is 0 and smooth, so the force on each falls to 0 there and the law has a
# continuous derivative; solutions exist and are unique through a collision. A unit vector has no limit where the
# agents coincide: it jumps when they pass through each other, the potential has a corner there, and the right-hand
# side is not Lipschitz.
#
# **Rubric, a point each:** the force vanishes smoothly at coincidence; a unit vector has no limit there, so that the
# law would be discontinuous.

# %% [markdown] tags=["exercise"]
# **8.** ★ (1 point, player) Move the slider of $h$. Which is the least $h$ on it at which the rim is above 2? (Its
# values are multiples of 0.1; exactly.)

# %% tags=["answer"]
least_h = ...

# %% tags=["solution"]
least_h = 0.6

# %% tags=["check"]
grade(least_h, 0.6, hint="the height of the rim stands in the inset")

# %% [markdown] tags=["exercise"]
# **9.** ★★★ (3 points, proof) Prove that $\|z\|_\sigma$ (a) is a strictly increasing function of $\|z\|$, (b) lies
# below $\|z\|/\sqrt\varepsilon$ and below $\tfrac12\|z\|^2$ for $z \ne 0$, and (c) is no norm.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# (a) As a function of $x = \|z\| \ge 0$ its derivative is $x/\sqrt{1+\varepsilon x^2}$, which is positive for
# $x > 0$. (b) Write it as $x^2/(\sqrt{1+\varepsilon x^2}+1)$. The denominator exceeds 2, so the quotient is below
# $\tfrac12x^2$. The derivative $x/\sqrt{1+\varepsilon x^2}$ is below $1/\sqrt\varepsilon$, and both sides are 0 at
# 0, so integrating gives the other bound. (c) A norm satisfies $\|2z\|_\sigma = 2\|z\|_\sigma$. For small $z$ the
# σ-norm behaves like $\tfrac12\|z\|^2$, so the quotient of both sides tends to 2 and not to 1: homogeneity fails.
#
# **Rubric, a point each:** the derivative is positive; both bounds with their reasons; homogeneity fails, with a
# reason.
