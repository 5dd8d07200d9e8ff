"""Columns of tables by their names, as tools of the field write them: one reading, which is stated, or a refusal."""

import numpy as np
import pandas as pd
import pytest

import flockana as fl
from flockana.base.errors import FlockanaError
from flockana.recorded.reading.column_words import unit_of, words_of


def table(path, header, *lines):
    """A table of rising numbers below a header, or of lines that are given."""
    count = header.count(",") + 1
    numbers = [",".join(f"{0.5 * k + j}" for j in range(count)) for k in range(2)]
    path.write_text("\n".join([header, *(lines or numbers)]) + "\n")
    return path


# header, columns of positions and of velocities, agents
READ = [
    ("stamp,x,y,z,qx,qy,qz,qw", "x y z", "", "0"),
    ("secs,tx,ty,tz,quat_x,quat_y,quat_z,quat_w", "tx ty tz", "", "0"),
    ("time,x,y,z,b.x,b.y,b.z,b.w", "x y z", "", "0"),
    ("t,x[3],y[3],x[4],y[4]", "1 2 3 4", "", "3 4"),
    ("t,x(7),x(8),x(9)", "1 2 3", "", "7 8 9"),
    ("t,pose.position.x,pose.position.y,pose.orientation.x,twist.linear.x,twist.linear.y", "1 2", "4 5", "0"),
    ("%time,header.stamp,pose.pose.position.x,pose.pose.position.y", "2 3", "", "0"),
    ("__time,/uav0/odometry/position/x,/uav0/odometry/position/y", "1 2", "", "0"),
    ("t,botA_x,botA_y,botB_x,botB_y", "1 2 3 4", "", "bot_A bot_B"),
    ("t,cf1_x,cf1_y,setpoint1_x,setpoint1_y", "1 2", "", "0"),
    ("time,bird_red_x,bird_red_y,bird_blue_x,bird_blue_y", "1 2 3 4", "", "bird_red bird_blue"),
    ("t,x,y,waypoint_x,waypoint_y", "1 2", "", "0"),
    ("t,px,py,vx,vy", "1 2", "3 4", "0"),
    ("t,x,y,px,py", "1 2", "3 4", "0"),
    ("t,xVelocity,yVelocity,xPos,yPos", "3 4", "1 2", "0"),
    ("t,qx,qy", "1 2", "", "0"),
]


@pytest.mark.parametrize(("header", "q", "p", "ids"), READ, ids=[header for header, *_ in READ])
def test_columns_are_read_by_their_meaning_and_said(tmp_path, header, q, p, ids):
    rec = fl.read_recording(table(tmp_path / "it.csv", header))
    names = header.split(",")
    at = [names.index(x) if x in names else int(x) for x in q.split()]
    assert rec.q[0].ravel().tolist() == [float(k) for k in at]
    assert ([] if rec.p is None else rec.p[0].ravel().tolist()) == [float(x) for x in p.split()]
    assert rec.ids == tuple(ids.split())
    text = "; ".join(rec.read_as)
    assert all(repr(names[k]) in text for k in at[: rec.m])
    assert text in repr(rec)


# header, what the message says
REFUSED = [
    ("t,qx,qy,qz,qw", "an orientation or a goal is none"),
    ("t,x,y,z,w", "positions and a weight, or a quaternion"),
    ("t,x,y,z,qx,qy,qz", "'x' and 'qx' may both be the position along x"),
    ("t,x,y,position_x,position_y", "'x' and 'position_x' may both be"),
    ("t,x,y,px,py,vx,vy", "'x' and 'px' may both be"),
    ("t,time,x,y", "'t', 'time' may be the times, or one of them another clock"),
    ("t,loc[0],loc[1]", "the axes of one agent, or agents on a line"),
    ("t,ann_x,ann_y,ben_x,ben_y", r"agents, or vectors of one agent, .*\"agents\": \['ann', 'ben'\]"),
    ("t,raw_x,raw_y,kalman_x,kalman_y", "agents, or vectors of one agent"),
    ("t,head_x,head_y,bot1_x,bot1_y", "agents, or vectors of one agent"),
    ("t,track,x1,y1,x2,y2", "vectors of the agent of 'track', or agents of their own"),
    ("t,x,y,x.1,y.1", "one agent, or several"),
    ("x1,y1,x2,y2", "expected dt=, the time from row to row"),
    ("when,a,b", "name them by columns="),
    ("timestamp,bird,latitude,longitude", "are angles: expected positions in a length"),
    ("Frame,X,Y,X,Y", r"'X' is given twice.*pandas.read_csv\(file, header="),
    ("time (s),x [mm],y [m]", "positions are in mm, m, or others: expected one unit"),
    ("t,x (px),y (px),vx (mm/s),vy (mm/s)", r"positions are in px, and p in mm/s: .* columns=.\"q\": \['x \(px\)'"),
    ("t,x11,x12,x21,x22", r"agents on a line, or axes of agents.*'11', '12', '21', '22'"),
    ("t,x_in,y_in,x_out,y_out", "agents, or vectors of one agent"),
]


@pytest.mark.parametrize(("header", "message"), REFUSED, ids=[header for header, _ in REFUSED])
def test_what_may_be_read_in_two_ways_is_refused_with_both(tmp_path, header, message):
    with pytest.raises(FlockanaError, match=message):
        fl.read_recording(table(tmp_path / "it.csv", header))


def test_a_twist_beside_an_orientation_is_said_to_be_along_the_axes_of_positions(tmp_path):
    header = "t,pose.position.x,pose.orientation.w,twist.linear.x"
    text = "'twist.linear.x' is taken along the axes of positions; where it is along a robot's own, name q alone"
    rec = fl.read_recording(table(tmp_path / "it.csv", header))
    assert (rec.p is not None, text in rec.read_as) == (True, True)
    alone = fl.read_recording(tmp_path / "it.csv", columns={"t": "t", "q": ["pose.position.x"]})
    assert (alone.p, text in alone.read_as) == (None, False)


def test_comments_above_a_table_count_as_lines(tmp_path):
    (tmp_path / "it.txt").write_text("# room 5\n# t,x,y\n0,1,2\n1,b,3\n")
    with pytest.raises(FlockanaError, match="line 4, column 'x': 'b'"):
        fl.read_recording(tmp_path / "it.txt")
    (tmp_path / "it.txt").write_text("NAMES\ta\tb\tc\nFrame\tTime\n1\t2\n")
    with pytest.raises(FlockanaError, match="do lines above the table describe it"):
        fl.read_recording(tmp_path / "it.txt")
    (tmp_path / "it.txt").write_bytes(b"\x89HDF\r\n\x1a\n\0")
    with pytest.raises(FlockanaError, match="it is HDF5; give its arrays by name"):
        fl.read_recording(tmp_path / "it.txt")


def test_the_argument_that_a_message_names_decides(tmp_path):
    path = table(tmp_path / "it.csv", "t,ann_x,ann_y,ben_x,ben_y")
    assert fl.read_recording(path, columns={"agents": ["ann", "ben"]}).ids == ("ann", "ben")
    assert fl.read_recording(path, columns={"q": ["ben_x", "ben_y"]}).q[0, 0].tolist() == [3.0, 4.0]
    path = table(tmp_path / "it.csv", "t,time,x,y")
    assert fl.read_recording(path, columns={"t": "time"}).t.tolist() == [1.0, 1.5]
    path = table(tmp_path / "it.csv", "when,kite,x,y", "0,a,1,2", "0,b,3,4")
    with pytest.raises(FlockanaError, match=r"has no times"):
        fl.read_recording(path)
    assert fl.read_recording(path, columns={"t": "when", "id": "kite"}).ids == ("a", "b")
    with pytest.raises(FlockanaError, match=r"has times in 'time' and dt = 0\.1 is given"):
        fl.read_recording(table(tmp_path / "it.csv", "time,x,y"), dt=0.1)


def test_rows_without_times_are_of_one_agent_only_where_no_column_may_name_others(tmp_path):
    path = table(tmp_path / "it.csv", "swan,x,y", "a,1,2", "a,2,3", "b,7,8", "b,8,9")
    with pytest.raises(FlockanaError, match=r"'swan' repeats: .*\"id\": 'swan'.*, or columns={\"q\": \['x', 'y'\]}"):
        fl.read_recording(path, dt=0.1)
    assert len(fl.read_recording(path, dt=0.1, columns={"q": ["x", "y"]}).t) == 4
    path = table(tmp_path / "it.csv", "Track n°,Slice n°,X,Y", "1,1,1,2", "1,2,2,3", "2,1,7,8", "2,2,8,9")
    assert fl.read_recording(path, dt=0.1).q[:, 1, 0].tolist() == [7.0, 8.0]
    assert fl.read_recording(table(path, "score,x", "1,3", "2,4", "3,5"), dt=0.1).n == 1


def test_numbers_of_agents_and_axes_are_no_agents_on_a_line_unless_stated(tmp_path):
    path = table(tmp_path / "it.csv", "t,x_1_1,x_1_2,x_2_1,x_2_2")
    assert fl.read_recording(path, columns={"agents": ["1_1", "1_2", "2_1", "2_2"]}).q.shape == (2, 4, 1)
    assert fl.read_recording(table(path, "t," + ",".join(f"x{k}" for k in range(1, 13)))).n == 12


def test_rows_that_are_sorted_and_arguments_that_say_nothing_are_told(tmp_path):
    again = table(tmp_path / "it.csv", "t,id,x", "0,1,1", "1,1,2", "0.5,1,9", "1.5,1,8")
    assert "rows are sorted by time, which falls 1 times" in fl.read_recording(again).read_as
    by_agent = table(again, "t,id,x", "0,1,1", "1,1,2", "0,2,9", "1,2,8")
    assert "sorted" not in repr(fl.read_recording(by_agent))
    for how, text in (({"axes": "time agent"}, "for arrays"), ({"clock": 60.0}, "for times that are dates")):
        with pytest.raises(FlockanaError, match=f"= .* is {text}, and there are none"):
            fl.read_recording(by_agent, **how)


def test_the_column_of_agents_is_the_one_whose_values_return(tmp_path):
    """As TrackMate writes spots: labels and numbers of spots are unique, and three lines more are no samples."""
    head = "LABEL,ID,TRACK_ID,POSITION_X,POSITION_Y,POSITION_Z,POSITION_T"
    words = ("Label,Spot ID,Track ID,X,Y,Z,T", "Label,Spot ID,Track ID,X,Y,Z,T", ",,,(µm),(µm),(µm),(s)")
    spots = ("ID7,7,0,1,2,0,0", "ID8,8,1,5,2,0,0", "ID9,9,0,1.5,2,0,1", "ID10,10,1,5.5,2,0,1")
    path = table(tmp_path / "spots.csv", head, *words, *spots)
    rec = fl.read_recording(path)
    assert rec.q[:, 1, 0].tolist() == [5.0, 5.5]
    assert "m=2 leaves it out" in repr(rec)
    assert "'LABEL', 'ID', whose values do not name an agent" in repr(rec)
    assert fl.read_recording(path, m=2).m == 2
    assert "not read, as m = 2: 'POSITION_Z'" in repr(fl.read_recording(path, m=2))
    with pytest.raises(FlockanaError, match=r"line 6, column 'POSITION_X': 'one'"):
        fl.read_recording(table(path, head, *words, spots[0], "ID8,8,1,one,2,0,0", *spots[2:]))
    twins = table(tmp_path / "it.csv", "t,bot,cell,x", "0,1,1,0", "1,1,2,0", "0,2,2,3", "1,2,1,3")
    with pytest.raises(FlockanaError, match="'bot', 'cell' may each be the agent"):
        fl.read_recording(twins)


@pytest.mark.parametrize(
    ("text", "rows", "said"),
    [
        ("t  x y\n0  1 2\n1 2   3\n", [[1.0, 2.0], [2.0, 3.0]], ""),
        ("# t x y\n0 1 2\n1 2 3\n", [[1.0, 2.0], [2.0, 3.0]], ""),
        ("# room 5\n# rate: 16 fps\n\n# t x y\n0 1 2\n1 2 3\n", [[1.0, 2.0], [2.0, 3.0]], ""),
        ("# room 5\nt,x,y\n0,1,2\n1,2,3\n", [[1.0, 2.0], [2.0, 3.0]], ""),
        ("t;x;y\n0;1,5;2\n1;-2,5;3,25\n", [[1.5, 2.0], [-2.5, 3.25]], "commas are decimal points"),
        ("t,x,y,,\n0,1,2,,\n1,2,3,,\n", [[1.0, 2.0], [2.0, 3.0]], "2 columns without a name are empty"),
        ("t,x,y\n0,1,2,\n1,2,,\n", [[1.0, 2.0], [np.nan, np.nan]], ""),
    ],
)
def test_blanks_decimal_commas_and_empty_columns(tmp_path, text, rows, said):
    (tmp_path / "it.txt").write_text(text)
    rec = fl.read_recording(tmp_path / "it.txt")
    np.testing.assert_array_equal(rec.q[:, 0], rows)
    assert said in repr(rec)


def test_velocities_come_into_the_units_of_positions_and_times(tmp_path):
    rec = fl.read_recording(table(tmp_path / "it.csv", "t [ms],x [cm],vx [m/s]", "0,1,3", "100,2,4"))
    assert rec.p[:, 0, 0].tolist() == pytest.approx([0.3, 0.4])  # 3 m/s are 300 cm in 1000 ms
    assert "p times 0.1, from m/s to cm and ms" in repr(rec)
    rec = fl.read_recording(table(tmp_path / "it.csv", "t,x [m],vx [cm/s]", "0,1,300", "1,4,300"))
    assert rec.p[:, 0, 0].tolist() == pytest.approx([3.0, 3.0])  # times without a unit are in that of velocities
    assert "p times 0.01, from cm/s to m and the time of cm/s" in repr(rec)
    rec = fl.read_recording(table(tmp_path / "it.csv", "t (s),x (in),vx (mph)", "0,1,1", "1,4,1"))
    assert rec.p[0, 0, 0] == pytest.approx(1609.344 / 3600.0 / 0.0254)
    assert (unit_of("mm/s^2").factor, unit_of("stones")) == (1e-3, None)
    assert words_of("posX_mm")[0] == ["pos", "x"]


def test_seconds_and_nanoseconds_and_counts_since_1970(tmp_path):
    pair = table(tmp_path / "it.csv", "stamp.sec,stamp.nanosec,x", "1700000000,750000000,1", "1700000002,0,2")
    assert fl.read_recording(pair).t.tolist() == [0.75, 2.0]
    counted = table(tmp_path / "it.csv", "timestamp,x", "1700000000000000000,1", "1700000000250000000,2")
    rec = fl.read_recording(counted)
    assert rec.t.tolist() == [0.0, 0.25]
    assert "t counts nanoseconds since 1970" in repr(rec)
    spans = pd.DataFrame({"t": pd.to_timedelta([5.0, 7.0], unit="s"), "x": [1.0, 2.0]})
    assert fl.read_recording(spans, clock=0.5).t.tolist() == [0.0, 4.0]
    with pytest.raises(FlockanaError, match="expected clock="):
        fl.read_recording(spans)


def test_stamps_that_differ_by_rounding_or_within_a_jitter_are_one_instant(tmp_path):
    rows = [f"{0.1 * k!r},a,{k}" for k in range(4)] + [f"{k / 10},b,{k}" for k in range(4)]
    rec = fl.read_recording(table(tmp_path / "it.csv", "t,id,x", *rows))
    assert (len(rec.t), rec.gaps) == (4, 0)  # 3 times 0.1 is not 0.3
    late = table(tmp_path / "it.csv", "t,id,x", *(f"{k + 0.004 * i},{i},{k}" for k in range(3) for i in range(2)))
    assert fl.read_recording(late).gaps == 6
    rec = fl.read_recording(late, jitter=0.01)
    assert (rec.gaps, rec.t[1]) == (0, pytest.approx(1.002))
    assert "stamps up to 0.004 apart are one instant: 6 are 3" in repr(rec)
    thirds = table(tmp_path / "it.csv", "t,id,x", *(f"{k + 0.3 * i},{i},{k}" for k in range(3) for i in range(3)))
    with pytest.raises(FlockanaError, match=r"jitter = 0.4: stamps from 0 to 2.6 follow each other within it"):
        fl.read_recording(thirds, jitter=0.4)


def test_many_visitors_at_common_times_are_read(tmp_path):
    """60 agents of whom each is there for 4 of 240 instants: 60 positions for each that is filled."""
    rows = [f"{4 * i + k},{i},{k}" for i in range(60) for k in range(4)]
    rec = fl.read_recording(table(tmp_path / "it.csv", "t,ped,x", *rows))
    assert (rec.n, len(rec.t), rec.gaps) == (60, 240, 60 * 236)


def test_agents_on_other_clocks_are_refused_or_interpolated_with_an_error_that_holds(tmp_path):
    """Positions sin(t + i) at 0.1 k + 0.03 i; one agent is hidden for a second, which stays a gap."""
    steps = [(i, 0.1 * k + 0.03 * i) for i in range(3) for k in range(40) if i != 1 or not 10 <= k < 20]
    path = table(tmp_path / "it.csv", "t,id,x", *(f"{t:.4f},{i},{np.sin(t + i):.9f}" for i, t in steps))
    with pytest.raises(
        FlockanaError, match=r"agents 0 and 1 are sampled at other times: of 39 and 29 samples .* 0 are"
    ):
        fl.read_recording(path, bound=1e-8)
    assert fl.read_recording(path, bound=1e-8, interpolate=False).gaps == 3 * 110 - 110
    rec = fl.read_recording(path, bound=1e-8, interpolate=1.0)
    assert rec.t == pytest.approx(0.1 * np.arange(40))
    assert rec.present.sum(axis=0).tolist() == [40, 28, 39]
    off = np.abs(rec.q[:, :, 0] - np.sin(rec.t[:, None] + np.arange(3)))
    assert (off <= rec.bound)[rec.present].all()
    largest = 0.5 * 0.03 * 0.07  # of a chord: a half times the distances to both samples
    assert rec.bound[rec.present].max() == pytest.approx(largest, rel=0.15)
    assert "interpolated to 40 instants of one agent: errors are 0.001" in repr(rec)
    slower = [(0, 0.1 * k) for k in range(40)] + [(1, 0.3 * k) for k in range(12)]  # some instants of the other
    path = table(tmp_path / "it.csv", "t,id,x", *(f"{t:.4f},{i},{t}" for i, t in slower))
    assert fl.read_recording(path).gaps == 40 - 12
    with pytest.raises(FlockanaError, match="interpolate = True: expected"):
        fl.read_recording(path, interpolate=True)
