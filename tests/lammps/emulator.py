"""A LAMMPS of few words: it reads the files as LAMMPS documents them, takes velocity-Verlet steps, and dumps.

It knows the commands that the export writes, and fails on any other. All pairs are looked at; a table is interpolated
linearly in the squared distance, energy and force over the distance.
"""

from pathlib import Path

import numpy as np

SKIPPED = ("units", "atom_style", "neighbor", "neigh_modify", "comm_modify", "thermo", "dump_modify")


def read_data(path: Path):
    """(box, positions, velocities) of a data file, atom style atomic: sections by keyword, a blank line after each."""
    lines = path.read_text().splitlines()
    header, sections, k = {}, {}, 1  # the first line is always skipped
    while k < len(lines):
        line = lines[k].split("#")[0].strip()
        if line in ("Masses", "Atoms", "Velocities"):
            assert lines[k + 1].strip() == ""
            count = header["atom types"][0] if line == "Masses" else header["atoms"][0]
            sections[line] = np.array([row.split() for row in lines[k + 2 : k + 2 + int(count)]], dtype=float)
            k += 2 + int(count)
        else:
            for keyword in ("atoms", "atom types", "xlo xhi", "ylo yhi", "zlo zhi"):
                if line.endswith(f" {keyword}"):
                    header[keyword] = [float(x) for x in line.removesuffix(keyword).split()]
            k += 1
    assert sections["Masses"].tolist() == [[1.0, 1.0]]
    n = int(header["atoms"][0])
    assert sections["Atoms"][:, 0].tolist() == sections["Velocities"][:, 0].tolist() == list(range(1, n + 1))
    box = np.array([header[f"{x}lo {x}hi"] for x in "xyz"])
    return box, sections["Atoms"][:, 2:5], sections["Velocities"][:, 1:4]


def read_table(path: Path, keyword: str):
    """(squared distances, energies, forces over distances) of a section with the parameter RSQ."""
    lines = iter(path.read_text().splitlines())
    first = next(line for line in lines if line.strip() and not line.startswith("#"))
    assert first.split()[0] == keyword
    parameters = next(lines).split()
    assert parameters[0] == "N"
    assert parameters[2] == "RSQ"
    n, low, high = int(parameters[1]), float(parameters[3]), float(parameters[4])
    assert next(lines) == ""
    rows = np.array([next(lines).split() for _ in range(n)], dtype=float)
    assert next(lines, None) is None
    assert rows[:, 0].tolist() == list(range(1, n + 1))
    assert 0.0 < low < high
    s2 = np.linspace(low**2, high**2, n)
    np.testing.assert_allclose(rows[:, 1], np.sqrt(s2), rtol=1e-12)
    return s2, rows[:, 2], rows[:, 3] / np.sqrt(s2)


class Lammps:
    """The state of a script that is read line by line; `dump` is the text that it wrote."""

    def __init__(self, folder: Path, script: str = "in.flock") -> None:
        self.folder, self.step, self.dt, self.dump = folder, 0, 0.0, ""
        self.variables, self.fixes = {}, []
        self.damping = None
        for line in (folder / script).read_text().splitlines():
            if line and not line.startswith("#"):
                name, _, rest = line.partition(" ")
                if name not in SKIPPED:
                    getattr(self, f"do_{name}")(*rest.split(None, 2 if name == "variable" else -1))

    def do_boundary(self, *faces):
        self.faces = " ".join(2 * face for face in faces)

    def do_dimension(self, m):
        self.m = int(m)

    def do_read_data(self, file):
        self.box, self.x, self.v = read_data(self.folder / file)
        assert (self.box[:, 0] <= self.x.min(axis=0)).all()
        assert (self.x.max(axis=0) <= self.box[:, 1]).all()

    def do_pair_style(self, *words):
        self.points = int(words[words.index("linear") + 1])
        self.style = words[0]
        assert self.style in ("table", "hybrid/overlay")

    def do_pair_coeff(self, i, j, *words):
        assert (i, j) == ("1", "1")
        if self.style == "hybrid/overlay":
            style, *words = words
            if style == "dpd/ext/tstat":
                across, along, s_across, s_along, self.damped = map(float, words)
                assert across == along
                assert s_across == s_along
                self.damping = across, s_across
                return
            assert style == "table"
        file, keyword, cutoff = words
        self.table = read_table(self.folder / file, keyword)
        assert len(self.table[0]) == self.points
        assert float(cutoff) ** 2 == self.table[0][-1]

    def do_timestep(self, dt):
        self.dt = float(dt)

    def do_variable(self, name, style, formula):
        assert style in ("equal", "atom")
        self.variables[name] = formula.strip('"').replace("^", "**")

    def do_fix(self, name, group, style, *words):
        assert group == "all"
        self.fixes.append((style, words))

    def do_dump(self, name, group, style, every, file, *columns):
        assert (group, style) == ("all", "custom")
        self.every, self.columns, self.file = int(every), columns, file

    def do_run(self, steps):
        assert self.fixes[0][0] == "nve"
        assert self.m == 3 or self.fixes[-1][0] == "enforce2d"
        force = self.force()
        self.write(force)
        for self.step in range(1, int(steps) + 1):
            self.v = self.v + 0.5 * self.dt * force
            self.x = self.x + self.dt * self.v
            force = self.force()
            self.v = self.v + 0.5 * self.dt * force
            if self.step % self.every == 0:
                self.write(force)

    def value(self, word):
        """A number, or the variable v_NAME."""
        if not word.startswith("v_"):
            return float(word)
        names = {axis: self.x[:, k] for k, axis in enumerate("xyz")}
        names |= {"step": self.step, "PI": np.pi, "sin": np.sin, "cos": np.cos, "sqrt": np.sqrt}
        formula = self.variables[word[2:]]
        names |= {f"v_{name}": self.value(f"v_{name}") for name in self.variables if f"v_{name}" in formula}
        return eval(formula, {"__builtins__": {}}, names)

    def force(self):
        delta = self.x[None] - self.x[:, None]
        s2 = np.sum(delta**2, axis=2) + 1e300 * np.eye(len(self.x))
        grid, _, over = self.table
        assert (s2 >= grid[0]).all(), "Pair distance < table inner cutoff"
        near = s2 < grid[-1]
        factor = np.where(near, np.interp(s2, grid, over), 0.0)
        force = -np.sum(factor[:, :, None] * delta, axis=1)
        if self.damping is not None:
            gamma, s = self.damping
            inside = s2 < self.damped**2
            weight = np.where(inside, (1.0 - np.sqrt(np.where(inside, s2, 0.0)) / self.damped) ** (2.0 * s), 0.0)
            force += gamma * np.sum(weight[:, :, None] * (self.v[None] - self.v[:, None]), axis=1)
        for style, words in self.fixes:
            if style == "viscous":
                force -= float(words[0]) * self.v
            elif style == "addforce":
                for k, word in enumerate(words):
                    force[:, k] += self.value(word)
            elif style == "enforce2d":
                force[:, 2], self.v[:, 2] = 0.0, 0.0
            else:
                assert style == "nve"
        return force

    def write(self, force):
        """A snapshot, agents in no order: LAMMPS sorts only where it is asked to."""
        order = np.random.default_rng(self.step).permutation(len(self.x))
        data = {"id": np.arange(1, len(self.x) + 1), "type": np.ones(len(self.x), int)}
        for k, axis in enumerate("xyz"):
            data |= {axis: self.x[:, k], f"v{axis}": self.v[:, k], f"f{axis}": force[:, k]}
        box = "".join(f"{low!r} {high!r}\n" for low, high in self.box.tolist())
        self.dump += f"ITEM: TIME\n{self.step * self.dt!r}\nITEM: TIMESTEP\n{self.step}\n"
        self.dump += f"ITEM: NUMBER OF ATOMS\n{len(self.x)}\nITEM: BOX BOUNDS {self.faces}\n{box}"
        self.dump += f"ITEM: ATOMS {' '.join(self.columns)} \n"
        for i in order.tolist():
            self.dump += " ".join(repr(data[name][i].item()) for name in self.columns) + " \n"
        (self.folder / self.file).write_text(self.dump)
