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
# # Find the error in this code
#
# **Aims.** Hold recorded motion against a law: compute what the law should have done, look at what is left, and name
# the error. Do it by hand once, then with the library; know what a recording can and cannot tell.
#
# ## A scene
#
# A student hands in a program and a film. The film does not look right: the agents jitter, or drift apart, or clump.
# The program has ninety lines, and all of them look plausible. You could read it until you see the error, or you
# could ask the *data*: positions and velocities at every step are there. **Which of the law's terms did the program
# compute, which did it not, and with what gain?** The same question is asked of starlings filmed over Rome and of
# drones that came back with a log file. The mathematics is a least-squares fit; the art is in the residual.
#
# ## Two agents, by hand
#
# Two agents on a line; the log says that at the distance 6 their accelerations are $\mp u$. Algorithm 1 would have
# $u = c_1^\alpha|\phi_\alpha|\cdot6/\sqrt{1+36\varepsilon} = 30\cdot2.148\cdot2.798 = 180.3$ at rest. Suppose that the
# log has 90.1, half of it. Is there a factor ½ in the code? Or has somebody used another vector with another gain? One
# number at one distance cannot tell. A *curve* over the distance can. Put the candidates side by side, as ratios to the
# law:
#
# | distance | law's $u$ | factor ½ | a unit vector in the place of $n_{ij}$ | $q_j - q_i$ itself |
# |---|---|---|---|---|
# | 6 | 180.3 | 0.5 | $\sqrt{4.6}/6 = 0.357$ | $\sqrt{4.6} = 2.14$ |
# | 7.5 | 27.9 | 0.5 | $\sqrt{6.625}/7.5 = 0.343$ | $\sqrt{6.625} = 2.57$ |
# | 8 | 6.6 | 0.5 | $\sqrt{7.4}/8 = 0.340$ | $\sqrt{7.4} = 2.72$ |
#
# A *constant* ratio is a wrong factor: some gain explains it exactly. A ratio that *changes* with the distance is a
# wrong form: no gain does. Look at the fourth column, though. Between 6 and 8 the unit vector's ratio changes by 5 %
# only, because $n_{ij}$ is nearly a vector of constant length out there (lecture 01). So this wrong form is nearly a
# wrong factor, and will hide behind a gain of about a third. Remember that when we meet it again.
#
# ## The program
#
# Here it is. It computes the input of all agents under Algorithm 1; `error` plants one of four mistakes that
# students have really made. Read it, and cover the `if` lines: would you have seen them?

# %%
import numpy as np

import flockana as fl
from flockana import plots
from flockana.course import Prediction, grade, is_own
from flockana.course.unknown_gains import unknown_program

law = fl.Algorithm1()
alpha, c1, c2 = law.alpha, law.gains.c1_alpha, law.gains.c2_alpha


def student(q, p, error):
    u = np.zeros_like(q)
    for i in range(len(q)):
        for j in range(len(q)):
            x = q[j] - q[i]
            distance = np.linalg.norm(x)
            if j == i or distance >= alpha.r:
                continue
            z = (np.sqrt(1.0 + alpha.eps * distance**2) - 1.0) / alpha.eps
            n = x / np.sqrt(1.0 + alpha.eps * distance**2)
            weight = alpha.bump(z / alpha.r_alpha)
            if error == "unit vector":
                n = x / distance
            if error == "no weight":
                weight = 1.0
            force = c1 * alpha.phi_alpha(z) * n
            if error == "half":
                force = 0.5 * force
            change = p[i] - p[j] if error == "sign" else p[j] - p[i]
            u[i] += force + c2 * weight * change
    return u


def record(error, step=0.005, steps=200):
    generator = np.random.default_rng(0)
    q = fl.lattice.hexagonal_patch(1, 7.0) + generator.normal(0.0, 0.3, (7, 2))
    p = generator.normal(0.0, 1.0, (7, 2))
    log = []
    for k in range(steps):
        log.append((k * step, q.copy(), p.copy()))
        p = p + step * student(q, p, error)
        q = q + step * p
    return [np.array(each) for each in zip(*log, strict=True)]


errors = ("none", "half", "unit vector", "no weight", "sign")
logs = {error: record(error) for error in errors}
figure, ax = plots.subplots(size=(6.5, 3.6))
for error, (t, _, p) in logs.items():
    ax.semilogy(t, np.linalg.norm(p - p.mean(axis=1, keepdims=True), axis=2).mean(axis=1), label=error)
ax.set(xlabel="time", ylabel="mean speed about the centre (length/time)")
_ = ax.legend()

# %% [markdown]
# **Figure 15.1.** Seven agents, five programs. Only the wrong sign is conspicuous. The other three errors look like
# flocks that calm down, one of them sooner than the right program, and without that one beside them nobody would
# object.
#
# ## The residual, by hand
#
# The log holds $q$ and $p$ at every step. The program steps $p \leftarrow p + \Delta t\,u$, so the accelerations it
# used are the differences $(p(t+\Delta t) - p(t))/\Delta t$, exactly. Compute the two terms of the law from the
# logged states,
#
# $$f_i = \sum_{j\in N_i}\phi_\alpha n_{ij}, \qquad g_i = \sum_{j\in N_i}a_{ij}(p_j - p_i),$$
#
# and ask which combination $c_1f + c_2g$ fits the logged accelerations $u$ best. Minimise
# $\sum\|u - c_1f - c_2g\|^2$ over all agents and times: put the derivatives with respect to $c_1$ and $c_2$ to 0,
#
# $$\begin{pmatrix} \sum\|f\|^2 & \sum\langle f, g\rangle \\ \sum\langle f, g\rangle & \sum\|g\|^2 \end{pmatrix}
# \begin{pmatrix} c_1 \\ c_2 \end{pmatrix} = \begin{pmatrix} \sum\langle f, u\rangle \\ \sum\langle g, u\rangle
#   \end{pmatrix} .$$
#
# These are the *normal equations*. They have one solution if $f$ and $g$ are not proportional. What is left,
# $u - c_1f - c_2g$, is the *residual*.
#
# <details><summary>With numbers</summary>
#
# **With numbers.** Three accelerations, $u = (3, 4, -2)$, with $f = (1, 2, 0)$ and $g = (0, 1, 1)$. The sums are
# $\sum f^2 = 5$, $\sum fg = 2$, $\sum g^2 = 2$, $\sum fu = 11$, $\sum gu = 2$:
#
# $$\begin{pmatrix} 5 & 2 \\ 2 & 2 \end{pmatrix}\begin{pmatrix} c_1 \\ c_2 \end{pmatrix} =
#   \begin{pmatrix} 11 \\ 2 \end{pmatrix} \quad\Longrightarrow\quad c_1 = \frac{22 - 4}{6} = 3, \quad
#   c_2 = \frac{10 - 22}{6} = -2 ,$$
#
# and $3f - 2g = (3, 4, -2)$ leaves nothing. Were the last acceleration $+1$ instead, the right-hand side would be
# $(11, 5)$, the gains $2$ and $\tfrac12$, and the residual $u - 2f - \tfrac12g = (1, -\tfrac12, \tfrac12)$: no gains
# explain the data.
#
# </details>
#
# > **Theorem (what a residual is).** At the best gains the residual is orthogonal to $f$ and to $g$, and
# > $\|u\|^2 = \|c_1f + c_2g\|^2 + \|u - c_1f - c_2g\|^2$. It is 0 if and only if some gains explain the data exactly.
#
# *Proof.*
#
# 1. The normal equations *say* that $\langle f, u - c_1f - c_2g\rangle = 0$ and the same for $g$.
# 2. So the residual is orthogonal to $c_1f + c_2g$ too, and Pythagoras gives the sum of squares.
# 3. If some gains leave nothing, the minimum is 0, and it is taken by the best ones. The converse is the definition.
#    $\square$
#
# (Check 1 on the example: $\langle f, (1, -\tfrac12, \tfrac12)\rangle = 1 - 1 = 0$, and for $g$: $-\tfrac12 + \tfrac12
# = 0$.) Three conclusions to use all the time. The residual lies between 0 and $\|u\|$, so its *share* is a fair
# measure. A wrong gain in the code cannot leave a residual. And to add a further candidate term never makes it larger,
# so a small residual with ten terms means less than one with two.


# %%
def terms(q, p):
    """The two sums of the law for unit gains, from the library."""
    only_force = fl.Algorithm1(gains=fl.Gains(c1_alpha=1.0, c2_alpha=1e-12))
    both = fl.Algorithm1(gains=fl.Gains(c1_alpha=1.0, c2_alpha=1.0))
    f = np.array([only_force.acceleration(0.0, a, b) for a, b in zip(q, p, strict=True)])
    return f, np.array([both.acceleration(0.0, a, b) for a, b in zip(q, p, strict=True)]) - f


fitted = {}
for error, (t, q, p) in logs.items():
    u = np.diff(p, axis=0) / (t[1] - t[0])
    f, g = terms(q[:-1], p[:-1])
    gains, *_ = np.linalg.lstsq(np.column_stack([f.ravel(), g.ravel()]), u.ravel(), rcond=None)
    rest = u - gains[0] * f - gains[1] * g
    fitted[error] = [*gains, np.linalg.norm(rest) / np.linalg.norm(u)]

# %% tags=["predict"]
guess = ...
Prediction(
    "Of the four programs with an error, how many leave a residual at the best gains?",
    guess,
    sum(share > 1e-3 for *_, share in fitted.values()),
)

# %%
for error, gains in fitted.items():
    print(f"{error:>11}: c1 = {gains[0]:7.3f}, c2 = {gains[1]:8.3f}, residual {gains[2]:.1e} of the whole")
print(f"the law has c1 = {c1:.3f}, c2 = {c2:.3f}")

# %% [markdown]
# Read the table like a detective.
#
# - **none**: both gains as they should be, nothing left. The program is right.
# - **half**: $c_1$ is half, *nothing left*. The form is right and a factor is wrong.
# - **sign**: $c_2$ has the wrong sign, nothing left.
# - **unit vector** and **no weight**: a residual, of 1 % and of 37 %. No gains explain the data, so a *form* is
#   wrong, though the first is well hidden. Which one? Look at the residual.

# %%
figure, axes = plots.subplots(1, 2, size=(11, 3.6))
for ax, error, name in zip(axes, ("unit vector", "no weight"), ("pair force", "friction"), strict=True):
    t, q, p = logs[error]
    u = np.diff(p, axis=0) / (t[1] - t[0])
    f, g = terms(q[:-1], p[:-1])
    left = u - c1 * f - c2 * g  # with the gains of the law, as they are documented
    term = f if name == "pair force" else g
    along = np.sum(left * term, axis=2) / np.linalg.norm(term, axis=2)
    ax.plot(np.linalg.norm(term, axis=2).ravel(), along.ravel(), ".", markersize=2)
    ax.set(xlabel=f"size of the law's {name} (unit gain)", ylabel="residual along it", title=error)

# %% tags=["facts"]
assert np.diff(logs["none"][2], axis=0).size == 2786
assert np.allclose(fitted["none"][:2], [c1, c2], rtol=1e-6)
assert np.allclose(fitted["half"][:2], [c1 / 2.0, c2], rtol=1e-6)
assert np.allclose(fitted["sign"][:2], [c1, -c2], rtol=1e-6)
assert max(fitted[error][2] for error in ("none", "half", "sign")) < 1e-6
assert min(fitted[error][2] for error in ("unit vector", "no weight")) > 5e-3
assert [f"{100.0 * fitted[error][2]:.0f}" for error in ("unit vector", "no weight")] == ["1", "37"]

# %% [markdown]
# **Figure 15.2.** What the documented law leaves over, against the size of one of its terms, a dot for each agent and
# time. Left: for the unit vector it grows with the pair force, which is wrong. Right: without the weight it grows with
# the friction.
#
# ## A curve instead of a number
#
# The residual says *where* the error is. Can the data also say what the program has *instead*? A gain is one number for
# all distances. Ask for more: let the friction of a pair have an unknown weight that depends on the distance, one
# number for each of eight intervals of distances. The inputs are linear in these eight numbers, so the same least
# squares finds them. Nothing of the law's formula for the weight goes in:

# %%
from itertools import pairwise


def weights(error, groups=8):
    """Mean distance and weight in each interval of distances, read off a log."""
    t, q, p = (each[:-1] for each in logs[error])
    u = np.diff(logs[error][2], axis=0) / (t[1] - t[0])
    lengths = np.linalg.norm(q[:, None] - q[:, :, None], axis=3)
    slips = p[:, None] - p[:, :, None]  # p_j - p_i
    linked = lengths[(lengths > 0.0) & (lengths < alpha.r)]
    edges = np.linspace(linked.min(), linked.max() + 1e-9, groups + 1)
    inside = [(lengths >= low) & (lengths < high) for low, high in pairwise(edges)]
    columns = np.column_stack([np.einsum("tij,tijk->tik", each, slips).ravel() for each in inside])
    found, *_ = np.linalg.lstsq(columns, (u - c1 * terms(q, p)[0]).ravel(), rcond=None)
    share = np.sum(slips**2, axis=3)  # what a pair counts in the fit
    return np.array([np.average(lengths[each], weights=share[each]) for each in inside]), found / c2


figure, ax = plots.subplots(size=(6.5, 3.2))
for error, marker in (("none", "o"), ("no weight", "s")):
    ax.plot(*weights(error), marker, linestyle="none", label=f"from the log of '{error}'")
x = np.linspace(6.0, 8.6, 200)
ax.plot(x, alpha.bump(alpha.sigma_norm(x) / alpha.r_alpha), color="black", linestyle="-", label="the law's weight")
ax.set(xlabel="distance of the pair (length)", ylabel="weight of the friction", ylim=(-0.1, 1.2))
_ = ax.legend()

# %% tags=["facts"]
middle, read = weights("none")
assert np.abs(read - alpha.bump(alpha.sigma_norm(middle) / alpha.r_alpha)).max() < 0.01
assert np.abs(weights("no weight")[1] - 1.0).max() < 1e-6

# %% [markdown]
# **Figure 15.3.** The weight of the friction, read off two logs by intervals of distances. The right program has the
# bump of the law; the other has 1 at all distances. It is no longer a guess which line of the program is wrong.
#
# So are the laws of starlings and of fish read off films. One pays for a curve with variance: each number rests on the
# pairs of one interval, the outer ones on very few. And of distances at which no pair has been, from 7.5 to the range
# here, one learns nothing.
#
# ## How sure is a gain?
#
# Let the accelerations have independent errors of standard deviation $e$, and let for a moment only $c_1$ be unknown.
#
# $$\begin{aligned}
# \frac{\langle f, u\rangle}{\|f\|^2} &= \frac{\langle f, c_1f + \text{errors}\rangle}{\|f\|^2}
#   = c_1 + \frac{\langle f, \text{errors}\rangle}{\|f\|^2} && \text{the fitted gain} \\
# \text{its variance} &= \frac{\sum f_k^2\,e^2}{\|f\|^4} = \frac{e^2}{\|f\|^2} && \text{independent errors}
# \end{aligned}$$
#
# So *a gain is known to $e/\|f\|$*. It gets better with the root of the number of samples, and in proportion to the
# size of the term. (For two gains the variances are $e^2$ times the diagonal of the inverse of the normal matrix, by
# the same two lines.) Take 50 samples at the start of the right program's log, and 50 at its end, when the flock has
# calmed down, and add errors with $e = 1$, four hundred times over:

# %%
t, q, p = logs["none"]
u = np.diff(p, axis=0) / (t[1] - t[0])
f, g = terms(q[:-1], p[:-1])
generator, sure = np.random.default_rng(2), {}
for name, part in (("first", slice(0, 50)), ("last", slice(149, 199))):
    columns = np.column_stack([f[part].ravel(), g[part].ravel()])
    stated = np.sqrt(np.diag(np.linalg.inv(columns.T @ columns)))
    noisy = u[part].ravel()[:, None] + generator.standard_normal((len(columns), 400))
    scatter = np.linalg.lstsq(columns, noisy, rcond=None)[0].std(axis=1)
    sure[name] = stated, scatter
    print(f"{name:>5} samples: c1 known to {scatter[0]:.3f}, c2 to {scatter[1]:.3f}; by the formula {stated.round(3)}")

# %% tags=["facts"]
assert all(np.abs(scatter / stated - 1.0).max() < 0.15 for stated, scatter in sure.values())
assert np.all(sure["last"][0] > 2.0 * sure["first"][0])

# %% [markdown]
# The same number of samples is worth less when the flock has calmed down, because there is less of $f$ and $g$ in them.
#
# ## The same with the library
#
# `fl.Recording` takes a log with the accuracy of its numbers, `fl.compare` does what we did, for more laws, more
# schemes and more kinds of mistakes, and says in words what it finds.

# %%
comparisons = {error: fl.compare(fl.Recording(*logs[error], bound=0.0), law) for error in errors}
for error, found in comparisons.items():
    print(f"{error:>11}: {'; '.join(found.findings)}")

# %% tags=["facts"]
assert comparisons["none"].explained > 0.999999
assert any("15" in text and "30" in text for text in comparisons["half"].findings)
assert any("-10.95" in text for text in comparisons["sign"].findings)
assert any("count alike" in text for text in comparisons["no weight"].findings)
assert any("semi-implicit" in text for text in comparisons["none"].findings)

# %% [markdown]
# It even names the scheme: *semi-implicit Euler of 0.005*. How can data know the integrator? Explicit Euler moves with
# the *old* velocity, $q(t+\Delta t) - q(t) = \Delta t\,p(t)$, semi-implicit Euler with the *new* one, $
# \Delta t\,p(t+\Delta t)$. Both velocities are in the log, so one subtraction decides:

# %%
t, q, p = logs["none"]
for scheme, velocity in (("explicit", p[:-1]), ("semi-implicit", p[1:])):
    off = np.abs(np.diff(q, axis=0) - (t[1] - t[0]) * velocity).max()
    print(f"{scheme:>13}: positions are off by at most {off:.1e}")

# %% [markdown]
# For the unit vector it reports a gain of about 10.5 instead of 30, which is the best that a wrong form allows. That is
# a clue, not a diagnosis: $30/10.5 = 2.9$ is near $7/\sqrt{1+4.9} = 2.88$, the factor between $n_{ij}$ and a unit
# vector at the distance 7. The last step is yours.
#
# ## Noise
#
# Logs of real machines are noisy. Let each position be off by an independent random amount of standard deviation $e$,
# and compute accelerations by second differences. The errors are
#
# $$\begin{aligned}
# \frac{q(t+\Delta t) - 2q(t) + q(t-\Delta t)}{\Delta t^2} &= \ddot q + \tfrac1{12}\Delta t^2\,q^{(4)} + \dots &&
#   \text{Taylor: error of the formula} \\
# \text{variance} &= \frac{(1 + 4 + 1)\,e^2}{\Delta t^4} && \text{squares of the three weights} \\
# \text{standard deviation} &= \sqrt6\,e/\Delta t^2 . && \text{error of the data}
# \end{aligned}$$
#
# With $e = 0.01$ and $\Delta t = 0.005$ the second is a thousand, and the law's accelerations are a few tens. *More
# samples make it worse.* The error of the formula grows with the step and that of the data falls, so there is a best
# step: the two are equal at $\Delta t^4 = 12\sqrt6\,e/|q^{(4)}|$. Try it on an exact solution whose positions are off
# by $10^{-4}$:

# %%
fine = fl.simulate(law, *(each[0] for each in logs["none"][1:]), (0.0, 1.0), t_eval=np.linspace(0.0, 1.0, 2001))
e = 1e-4
blurred = fine.q + e * np.random.default_rng(1).standard_normal(fine.q.shape)
strides = np.array([4, 6, 10, 16, 24, 32, 40, 50, 64, 80, 100])
found = {"noisy positions": [], "exact positions": []}
for k in strides:
    for name, x in zip(found, (blurred, fine.q), strict=True):
        second = (x[2 * k :] - 2.0 * x[k:-k] + x[: -2 * k]) / (k * 5e-4) ** 2
        found[name].append(np.std(second - fine.u[k:-k]))
figure, ax = plots.subplots(size=(6.5, 3.2))
for name, errors_found in found.items():
    ax.loglog(strides * 5e-4, errors_found, label=name)
ax.loglog(strides * 5e-4, np.sqrt(6.0) * e / (strides * 5e-4) ** 2, label="the formula for noise alone")
ax.minorticks_off()
ax.set_xticks([0.002, 0.005, 0.01, 0.02, 0.05], ["0.002", "0.005", "0.01", "0.02", "0.05"])
ax.set(xlabel="step of the differences (time)", ylabel="error of accelerations")
_ = ax.legend()
fourth = np.diff(fine.u, 2, axis=0) / 5e-4**2
print(f"best step {strides[np.argmin(found['noisy positions'])] * 5e-4:.3f}, ", end="")
print(f"by hand {(12.0 * np.sqrt(6.0) * e / np.sqrt(np.mean(fourth**2))) ** 0.25:.3f}")

# %% tags=["facts"]
assert 0.015 < strides[np.argmin(found["noisy positions"])] * 5e-4 < 0.03
assert f"{0.01 / (np.sqrt(2.0) * 0.005):.1f} {np.sqrt(6.0) * 0.01 / 0.005**2:.0f}" == "1.4 980"
assert 0.02 < (12.0 * np.sqrt(6.0) * e / np.sqrt(np.mean(fourth**2))) ** 0.25 < 0.025
matrix, right_side = np.array([[5.0, 2.0], [2.0, 2.0]]), np.array([[11.0, 11.0], [2.0, 5.0]])
assert np.allclose(np.linalg.solve(matrix, right_side), [[3.0, 2.0], [-2.0, 0.5]])
lengths = np.array([6.0, 7.5, 8.0])
pull = (
    np.array([float(alpha.phi_alpha(alpha.sigma_norm(x))) for x in lengths]) * lengths / np.sqrt(1 + 0.1 * lengths**2)
)
assert [f"{30.0 * abs(each):.1f}" for each in pull] == ["180.3", "27.9", "6.6"]
assert [f"{each:.3f}" for each in np.sqrt(1 + 0.1 * lengths**2) / lengths] == ["0.357", "0.343", "0.340"]
assert [f"{each:.2f}" for each in np.sqrt(1 + 0.1 * lengths**2)] == ["2.14", "2.57", "2.72"]

# %% [markdown]
# **Figure 15.4.** Errors of accelerations from second differences, over the step. Left of the best step the noise
# decides, right of it the formula. No step is good: at best the error is 0.7.
#
# Better than differences is to smooth, or to compare not accelerations but whole solutions: start at a sample, let the
# law run for a while, and compare with the next samples. A recording says how accurate it is, and what is not above
# that accuracy is not found. Does the formula for noise hold for the log?

# %%
t, q, p = logs["half"]
generator = np.random.default_rng(1)
for e in (1e-6, 1e-3):
    blurred = q + e * generator.standard_normal(q.shape)
    twice = np.diff(blurred, 2, axis=0) / (t[1] - t[0]) ** 2
    true = np.diff(q, 2, axis=0) / (t[1] - t[0]) ** 2
    formula = np.sqrt(6.0) * e / 0.005**2
    print(f"positions off by {e:g}: accelerations off by {np.std(twice - true):.2g}, by the formula {formula:.2g}")

# %% tags=["facts"]
assert abs(np.std(twice - true) / (np.sqrt(6.0) * 1e-3 / 0.005**2) - 1.0) < 0.1

# %% [markdown]
# ## A procedure
#
# Put the steps in order, and they become a tool for any law and any log.
#
# 1. *Accelerations.* From velocities if they are in the log, else from second differences with the best step.
# 2. *Terms.* Write the documented law as a sum of terms with gains, and compute each from the logged states.
# 3. *Fit.* Solve the normal equations; report gains and the share of the residual.
# 4. *Residual at the level of the data's error?* Then look at the gains: each that is off names a wrong factor or sign.
# 5. *Residual above it?* Then a form is wrong. Take the residual at the *documented* gains and plot it over the
#    distance, over the relative velocity, over time, over the agent's number. Where it is 0 the law is right; where it
#    grows the error acts.
# 6. *Halve the step of the program* and record again. What shrinks was the integrator.
# 7. *Mend and repeat.* There may be a second error behind the first.
#
# Step 5 asks for the documented gains and not for the fitted ones. Why? The fit spends the gains to make the residual
# small, and so smears the error over all terms. With the wrong form "unit vector" the fitted gain is 10.5 instead of
# 30, and the residual is 1 % of the whole, spread everywhere. At the documented gain it is large, and points along the
# force.
#
# **When can gains be told apart?** Only if the recording *excites* both terms. In a flock that has come to rest $g$ is
# 0, and no log of it, however long, says anything about friction. In a flock at its lattice $f$ is 0. The best
# recording of a law starts far from where the law wants to go, and is short. (Exercise 7 makes this precise: the matrix
# of the normal equations is definite exactly if $f$ and $g$ are not proportional.) Control engineers know this as
# *persistent excitation*. It is why one shakes a machine in order to identify it.
#
# ## What surprised, and what a recording does not say
#
# A wrong factor leaves no residual, a wrong form leaves one, and both look like flocks. A wrong form can hide behind a
# wrong factor, as the unit vector does. The data know the integrator. More samples may know less. But a recording shows
# only the states that occurred: if all agents stayed within 6 and 8 of each other, nothing is known of the force at 3.
# Two laws that agree there are the same to the data. And a law that explains everything need not be the law that was
# programmed: of two terms that are proportional along the whole recording only the sum is known. For starlings the
# honest conclusion is "consistent with", and never "is".
#
# ## Questions that come up
#
# *Why compare with the law's terms and not with the program's?* The program is what is in doubt. Whoever takes terms
# from the program finds that it does what it does.
#
# *Can two errors cancel?* In one recording, yes: a force that is too weak and a friction that is too strong may give
# nearly the same motion. Record another start; errors that cancel for one rarely do so for the next.
#
# *My log has positions only. Where do I get velocities for the friction?* From central differences,
# $(q(t+\Delta t) - q(t-\Delta t))/(2\Delta t)$. They belong to the time $t$, as the second differences do. One-sided
# differences belong to half a step earlier or later, and a fit with them finds gains that are a little off. Noise is
# milder here than in accelerations: the standard deviation is $e/(\sqrt2\,\Delta t)$, with $e = 0.01$ and
# $\Delta t = 0.005$ that is 1.4, instead of a thousand.
#
# *The program cuts forces off at a limit. Would I see it?* Yes, if the recording reaches the limit. In a plot like
# Figure 15.2 the residual along the force is 0 up to some size, and from there on it falls along a straight line of
# slope $-c_1$. The corner is the limit.
#
# *How many agents and samples do I need?* Two gains need two independent numbers. All others serve to see whether the
# form is right, and to average noise. The seven agents of this lecture give 2 786 numbers for two gains.
#
# ## Summary
#
# - Accelerations from a log are fitted by the law's terms; the normal equations give gains, and the residual shows
#   what no gain explains.
# - A wrong factor or sign: gains off, residual 0. A wrong form: a residual, whose dependence on distance and
#   velocity names the term.
# - Differencing multiplies noise by $\sqrt6/\Delta t^2$; a recording must state its accuracy.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★★ (2 points, derivation) Positions are known to a standard deviation of 0.002, sampled every 0.1. (a) With
# which standard deviation are accelerations known from second differences? (b) And if every other sample is left
# out? Give the list, each to three significant digits.

# %% tags=["answer"]
blur = ...

# %% tags=["solution"]
blur = [np.sqrt(6.0) * 0.002 / 0.1**2, np.sqrt(6.0) * 0.002 / 0.2**2]

# %% tags=["check"]
grade(blur, [0.489897949, 0.122474487], digits=3, hint="q(t+Δt) − 2 q(t) + q(t−Δt): three independent errors")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, program) Plant an error of your own: write a function `flawed(q, p)` that returns inputs of
# Algorithm 1 with its default gains in which friction is *missing*, and everything else is right.

# %% tags=["answer"]
flawed = ...


# %% tags=["solution"]
def without_friction(q, p):
    return fl.Algorithm1().acceleration(0.0, q, 0.0 * np.asarray(p))


flawed = without_friction

# %% tags=["check"]
grade(
    flawed,
    lambda f: (
        is_own(f)
        and all(
            np.allclose(f(q, p), fl.Algorithm1().acceleration(0.0, q, 0.0 * p), atol=1e-9)
            for q in (np.array([[0.0, 0.0], [6.0, 0.0]]), np.array([[0.0, 0.0], [7.5, 0.0], [3.0, 6.0]]))
            for p in (np.ones_like(q), q**2 / 9.0)
        )
    ),
    form="function",
    hint="which argument does friction need?",
)

# %% [markdown] tags=["exercise"]
# **3.** ★★★ (3 points, experiment) `unknown_program()` returns the log of a program whose gains nobody tells you, as a
# `Recording`. Compare it with `law`. Which gain $c_2^\alpha$ has the program? (Three significant digits.)

# %% tags=["answer"]
unknown_gain = ...

# %% tags=["solution"]
comparison = fl.compare(unknown_program(), law)
print(comparison)
unknown_gain = next(share.found for share in comparison.shares if share.symbol == "c2α")

# %% tags=["check"]
grade(unknown_gain, 6.3, digits=3, hint="fl.compare(unknown_program(), law) prints the gains")

# %% [markdown] tags=["exercise"]
# **4.** ★ (1 point, player) A `Recording` has no player, a `Trajectory` has. Simulate `law` from the start of the
# log "sign" for 1 time unit, show its player, and compare with Figure 15.1: to which part of its start does the
# mean speed about the centre fall under the right program? (Two significant digits.)

# %% tags=["answer"]
calmed = ...

# %% tags=["solution"]
right = fl.simulate(law, logs["sign"][1][0], logs["sign"][2][0], (0.0, 1.0))
right.player()
about = np.linalg.norm(right.p - right.p.mean(axis=1, keepdims=True), axis=2).mean(axis=1)
print(about[[0, -1]])
calmed = about[-1] / about[0]

# %% tags=["check"]
grade(calmed, 0.179147, digits=2, hint="look at the arrows, or compute the mean speeds")

# %% [markdown] tags=["exercise"]
# **5.** ★★ (2 points, counterexample) Counterexample hunt: "If gains fit exactly and the residual is 0, the program
# is right." Give two agents on a line, $[x_1, x_2, v_1, v_2]$, at least 1 apart and with velocities that differ by at
# least 1, at which the error "no weight" has no effect at all on the inputs, although there is friction.

# %% tags=["answer"]
silent = ...

# %% tags=["solution"]
silent = [0.0, 2.0, 1.0, -1.0]  # nearer than 2.95 the bump is 1: weighted or not, the friction is the same

# %% tags=["check"]
grade(
    silent,
    lambda x: (
        len(x) == 4
        and abs(x[1] - x[0]) >= 1.0
        and abs(x[3] - x[2]) >= 1.0
        and fl.AlphaInteraction().adjacency(fl.AlphaInteraction().sigma_norm(abs(x[1] - x[0]))) == 1.0
    ),
    form="list",
    hint="which term has the weight, and at which distances is that weight 1?",
)

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) A program's film looks right and its residual against the documented law is 3 %. The
# author says: "3 % is the integrator." How would you find out? Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Halve the step and record again: an error of the integrator shrinks with the step, a wrong form stays. Or compute
# the accelerations from the scheme itself, as the difference of logged velocities over the step, which is exact for
# Euler schemes; then the integrator contributes nothing and the 3 % must be a form. Then plot the residual against
# distance and relative velocity to see which term it belongs to.
#
# **Rubric, a point each:** a test that separates step size from form; a look at the dependence of the residual.

# %% [markdown] tags=["exercise"]
# **7.** ★★★ (3 points, proof) Derive the normal equations, prove that their matrix is positive definite exactly if
# $f$ and $g$ (as vectors of all agents and times) are not proportional, and describe a recording for which they are
# proportional, so that the two gains cannot be told apart.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# The sum $\|u - c_1f - c_2g\|^2$ is a quadratic function of the gains. Its derivative with respect to $c_1$ is
# $-2\langle f, u - c_1f - c_2g\rangle$, and likewise for $c_2$; both 0 are the normal equations. For a vector $z$ of
# two numbers the quadratic form of the matrix is $\|z_1f + z_2g\|^2 \ge 0$, which is 0 for some $z \ne 0$ exactly if
# $f$ and $g$ are proportional (or one of them is 0). Example: two agents on a line at one instant have accelerations
# along one direction only, so with a single sample $f$ and $g$ are proportional; so are they when all agents are at
# rest all the time, where $g = 0$.
#
# **Rubric, a point each:** the derivatives; definiteness by the norm of a combination; a recording with proportional
# terms.
