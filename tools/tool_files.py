"""Write one flock as Motive, idtracker.ai, TrackMate, ROS and LAMMPS do (`python -m tools.tool_files .`).

The how-to docs/howto/recorded-tools.md reads these files.
"""

import sys
from pathlib import Path

import numpy as np

import flockana as fl
from flockana.base.value_checks import FloatArray

LAW = fl.Algorithm1(alpha=fl.AlphaInteraction(d=1.0, r=1.2), gains=fl.Gains(c1_alpha=2.0, c2_alpha=1.0))
NAMES = ("cf1", "cf2", "cf3")
RATE, FRAMES = 25.0, 101


def flock(late: float = 0.0) -> fl.Trajectory:
    """Three agents about 1 apart for four time units, sampled at RATE, perhaps a little late."""
    t = np.arange(FRAMES) / RATE + late
    q0, p0 = [[0.0, 0.0], [1.1, 0.1], [0.5, 0.8]], [[0.3, 0.0], [0.2, 0.1], [0.3, -0.1]]
    return fl.simulate(LAW, q0, p0, (0.0, float(t[-1])), t_eval=t)


def motive(q: FloatArray) -> str:
    """A take that OptiTrack Motive exports: rigid bodies, each with a quaternion, its place and a marker error."""
    each = [("Rotation", x) for x in "XYZW"] + [("Position", x) for x in "XYZ"] + [("Mean Marker Error", "")]
    columns = [(name, kind, axis) for name in NAMES for kind, axis in each]
    lines = [
        "Format Version,1.23,Take Name,flock,Capture Frame Rate,25.0,Export Frame Rate,25.0,Length Units,Meters",
        "",
    ]
    lines += [",Type," + ",".join("Rigid Body" for _ in columns), ",Name," + ",".join(x[0] for x in columns)]
    lines += [",ID," + ",".join(x[0] for x in columns), ",," + ",".join(x[1] for x in columns)]
    lines += ["Frame,Time (Seconds)," + ",".join(x[2] for x in columns)]
    for k, places in enumerate(q.tolist()):
        cells = [f"0,0,0,1,{x:.6f},{y:.6f},1.000000,0.000200" for x, y in places]
        lines.append(f"{k},{k / RATE:.6f}," + ",".join(cells))
    return "\n".join(lines) + "\n"


def trackmate(q: FloatArray) -> str:
    """Spots that TrackMate exports: four lines of a header, numbers of spots, tracks and frames; one is missed."""
    names = "LABEL,ID,TRACK_ID,QUALITY,POSITION_X,POSITION_Y,POSITION_Z,POSITION_T,FRAME,RADIUS"
    lines = [names, names.title().replace("_", " "), names.title().replace("_", " "), ",,,,µm,µm,µm,s,,µm"]
    for i in range(q.shape[1]):
        for k in range(len(q)):
            if (k, i) != (50, 1):
                spot, (x, y) = 1000 + k * q.shape[1] + i, q[k, i]
                lines.append(f"ID{spot},{spot},{i},5.5,{x:.6f},{y:.6f},0,{k / RATE:.6f},{k},0.25")
    return "\n".join(lines) + "\n"


def odometry(run: fl.Trajectory, i: int) -> str:
    """Messages nav_msgs/Odometry of one robot, as `rostopic echo -p` prints them; its twist is in the robot's frame."""
    pose = [f"field.pose.pose.position.{x}" for x in "xyz"] + [f"field.pose.pose.orientation.{x}" for x in "xyzw"]
    twist = [f"field.twist.twist.linear.{x}" for x in "xyz"] + [f"field.twist.twist.angular.{x}" for x in "xyz"]
    lines = [",".join(["%time", "field.header.seq", "field.header.stamp", "field.header.frame_id", *pose, *twist])]
    for k, t in enumerate(run.t.tolist()):
        stamp, (x, y), turn = round((1.7e9 + t) * 1e9), run.q[k, i].tolist(), 0.25 * np.pi  # turned by 90 degrees
        p, sine = run.p[k, i].tolist(), np.sin(turn)
        numbers = [x, y, 0.1, 0.0, 0.0, sine, sine, p[1], -p[0], 0.0, 0.0, 0.0, 0.0]
        lines.append(f"{stamp + 2_000_000},{k},{stamp},odom," + ",".join(f"{x:.6f}" for x in numbers))
    return "\n".join(lines) + "\n"


def dump(run: fl.Trajectory) -> str:
    """A text dump of LAMMPS with velocities, every 40 steps of 0.001."""
    lines = []
    for k in range(len(run.t)):
        lines += ["ITEM: TIMESTEP", f"{40 * k}", "ITEM: NUMBER OF ATOMS", f"{run.q.shape[1]}"]
        lines += ["ITEM: BOX BOUNDS ff ff pp", "-9 9", "-9 9", "-0.5 0.5", "ITEM: ATOMS id type x y z vx vy vz"]
        for i, (place, speed) in enumerate(zip(run.q[k].tolist(), run.p[k].tolist(), strict=True), 1):
            numbers = [*place, 0.0, *speed, 0.0]
            lines.append(f"{i} 1 " + " ".join(f"{x:.9g}" for x in numbers))
    return "\n".join(lines) + "\n"


def write_tool_files(folder: Path) -> None:
    """Write all files into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    run = flock()
    texts = {"take.csv": motive(run.q), "spots.csv": trackmate(run.q), "flock.dump": dump(run)}
    texts |= {f"{name}.csv": odometry(flock(0.013 * i), i) for i, name in enumerate(NAMES)}
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    video = {"trajectories": 200.0 * run.q + 300.0, "frames_per_second": RATE, "body_length": 40.0, "version": "5.2.12"}
    np.save(folder / "trajectories.npy", np.array(video, dtype=object), allow_pickle=True)


if __name__ == "__main__":
    write_tool_files(Path(sys.argv[1]))
