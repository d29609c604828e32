#!/usr/bin/env bash
# Other tools' own readers open what a run and `sphode export` write, and find the same numbers:
# h5py and yt (snapshots, GADGET's layout), VTK (VTU; VTKHDF), gnuplot (CSV).  One that is not here
# is skipped; Debian: python3-h5py, python3-yt, python3-vtk9, gnuplot-nox.
sphode=${SPHODE:-$BUILDDIR/sphode}
stage=$(mktemp -d) || exit 99
trap 'rm -rf "$stage"' EXIT
cd "$stage" || exit 99

count=0
ok() { # 0 or not, name
  count=$((count + 1))
  if [[ $1 == 0 ]]; then echo "ok $count - $2"; else echo "not ok $count - $2"; fi
}
# The Python that has this module, the system's among them.
python_with() {
  local python
  for python in python3 /usr/bin/python3; do
    "$python" -c "import $1" 2>/dev/null && echo "$python" && return
  done
  return 1
}
# read NAME MODULE: the program on standard input prints nothing but "right" where it is.
read_by() {
  local python
  python=$(python_with "$2") || { ok 0 "$1 # SKIP no Python module $2" && return; }
  "$python" - >out 2>&1 && [[ $(cat out) == right ]]
  local status=$?
  [[ $status == 0 ]] || sed 's/^/# /' out
  ok $status "$1"
}

"$sphode" run "$SRCDIR/cases/dam-break-2d.yml" -q -o run --set "parameters.dx=H/10" --set "run.end=T" \
  --set "output.snapshots=T/2" --set "output.series=T/2" >out 2>&1 || sed 's/^/# /' out
[[ -e run/snapshot_0002.hdf ]]
ok $? "a run"
for format in csv vtu gadget; do "$sphode" export run --$format -q || break; done
ok $? "exported"
"$sphode" export run --gadget --float32 --fields velocity -q -o half
ok $? "in single precision"

read_by "h5py: GADGET's layout is the snapshot" h5py <<'END'
import h5py
for name in ("snapshot_0000", "snapshot_0002"):
    a, b, half = (h5py.File(f, "r") for f in
                  (f"run/{name}.hdf", f"run/gadget/{name}.hdf5", f"half/{name}.hdf5"))
    for part in ("PartType0", "PartType1"):
        n = b["Header"].attrs["NumPart_ThisFile"][int(part[-1])]
        assert set(a[part]) == set(b[part]) and n == len(b[part]["Coordinates"]) > 10
        for field in b[part]:
            assert (a[part][field][()] == b[part][field][()]).all(), field
        assert set(half[part]) == {"Coordinates", "Velocities"}
        assert half[part]["Velocities"].dtype == "<f4"
        assert abs(half[part]["Velocities"][()] - b[part]["Velocities"][()]).max() < 1e-6
    assert b["PartType0/Velocities"].attrs["unit"] == b"m/s"
    assert b["Header"].attrs["Time"] == a["Header"].attrs["Time"]
    assert b["Header"].attrs["Flag_DoublePrecision"] == 1 - half["Header"].attrs["Flag_DoublePrecision"]
print("right")
END

read_by "VTK: VTU and its series are the snapshots" vtk <<'END'
import re, vtk
from vtk.util.numpy_support import vtk_to_numpy as numbers
series = re.findall(r'timestep="([^"]+)" file="([^"]+)"', open("run/vtu/snapshot.pvd").read())
assert len(series) == 3
for time, name in series:
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName("run/vtu/" + name)
    reader.Update()
    grid = reader.GetOutput()
    data = {grid.GetPointData().GetArrayName(k): numbers(grid.GetPointData().GetArray(k))
            for k in range(grid.GetPointData().GetNumberOfArrays())}
    assert grid.GetNumberOfCells() == grid.GetNumberOfPoints() == 50
    assert all(grid.GetCellType(i) == vtk.VTK_VERTEX for i in range(grid.GetNumberOfCells()))
    assert grid.GetFieldData().GetArray("TimeValue").GetValue(0) == float(time)
    table = [line.split(",") for line in open("run/csv/" + name.replace("vtu", "csv"))]
    x, v = table[0].index("x [m]"), table[0].index("velocity_y [m/s]")
    assert len(table) - 1 == grid.GetNumberOfPoints()
    for i, row in enumerate(table[1:]):
        assert abs(float(row[x]) - grid.GetPoint(i)[0]) < 1e-13
        assert abs(float(row[v]) - data["velocity [m/s]"][i][1]) < 1e-13
print("right")
END

read_by "VTK: VTKHDF of the snapshots themselves" vtk <<'END'
import vtk
for name in ("snapshot_0002", "walls_0002"):
    other = vtk.vtkXMLUnstructuredGridReader()
    other.SetFileName(f"run/vtu/{name}.vtu")
    reader = vtk.vtkHDFReader()
    reader.SetFileName(f"run/{name}.hdf")
    for r in (reader, other):
        r.Update()
    a, b = reader.GetOutput(), other.GetOutput()
    assert a.GetNumberOfPoints() == b.GetNumberOfPoints() >= 50
    p, q = a.GetPointData().GetArray("Pressure"), b.GetPointData().GetArray("pressure [Pa]")
    for i in range(a.GetNumberOfPoints()):
        assert a.GetPoint(i) == b.GetPoint(i) and p.GetTuple(i) == q.GetTuple(i)
print("right")
END

read_by "yt: GADGET's layout, in SI" yt <<'END'
import h5py, yt
yt.set_log_level("critical")
for name in ("run/snapshot_0002.hdf", "run/gadget/snapshot_0002.hdf5"):
    x = h5py.File(name)["PartType0/Coordinates"][()]
    walls = h5py.File(name)["PartType1/Coordinates"][()]
    low = [min(x[:, d].min(), walls[:, d].min()) - 0.1 for d in range(3)]
    high = [max(x[:, d].max(), walls[:, d].max()) + 0.1 for d in range(3)]
    ds = yt.load(name, bounding_box=list(zip(low, high)),
                 unit_base={"length": (1, "m"), "mass": (1, "kg"), "velocity": (1, "m/s")})
    data = ds.all_data()
    y = data["PartType0", "Coordinates"].to("m").d
    v = data["PartType0", "Velocities"].to("m/s").d
    rho = data["PartType0", "Density"].to("kg/m**3").d
    right = h5py.File(name)["PartType0"]
    assert max(abs(p - q) for p, q in zip(sorted(y[:, 0]), sorted(x[:, 0]))) < 1e-12 and len(data["PartType1", "Masses"]) == len(walls)
    pairs = zip(sorted(v[:, 1]), sorted(right["Velocities"][()][:, 1]))
    assert max(abs(p - q) for p, q in pairs) < 1e-12
    assert abs(rho.mean() / right["Density"][()].mean() - 1) < 1e-12
    assert abs(float(ds.current_time.to("s")) - h5py.File(name)["Header"].attrs["Time"]) < 1e-9
print("right")
END

# GADGET's initial conditions by other hands: float32, one mass for all in the header, no density.
cat >case.yml <<'END'
dimension: 3
spacing: 0.1 m
groups:
  gas: {kind: fluid, density: 2 kg/m^3, shapes: [file: {path: start.hdf5}], eos: {ideal-gas: {gamma: 1.4}}}
terms: {continuity: {}, pressure: {}}
run: {end: 1e-6 s}
END
read_by "h5py: initial conditions come in" h5py <<END
import h5py, numpy, subprocess
rng = numpy.random.default_rng(1)
x = (numpy.argwhere(numpy.ones((6, 6, 6))) + 0.5) * 0.1
v = rng.normal(size=x.shape)
with h5py.File("start.hdf5", "w") as f:
    head = f.create_group("Header")
    head.attrs["NumPart_ThisFile"] = numpy.array([len(x), 0, 0, 0, 0, 0], dtype="u4")
    head.attrs["MassTable"] = numpy.array([0.25, 0, 0, 0, 0, 0])
    head.attrs["Time"] = 0.0
    gas = f.create_group("PartType0")
    gas["Coordinates"] = x.astype("f4")
    gas["Velocities"] = v.astype("f4")
    gas["ParticleIDs"] = numpy.arange(len(x), dtype="u4")
    gas["InternalEnergy"] = numpy.full(len(x), 3, dtype="f4")
subprocess.run(["$sphode", "run", "case.yml", "-q", "-o", "started"], check=True)
with h5py.File("started/snapshot_0000.hdf", "r") as f:
    gas = f["PartType0"]
    assert (gas["Coordinates"][()] == x.astype("f4")).all()
    assert (gas["Velocities"][()] == v.astype("f4")).all()
    assert (gas["Masses"][()] == 0.25).all() and (gas["InternalEnergy"][()] == 3).all()
    assert (gas["Density"][()] == 2).all()
print("right")
END

if command -v gnuplot >/dev/null; then
  found=$(gnuplot -e "set datafile separator ','; set print '-';
    stats 'run/csv/snapshot_0002.csv' using (column('density [kg/m^3]')) name 'd' nooutput;
    stats 'run/series.csv' using (column('time [s]')) name 't' nooutput;
    print sprintf('%d %.0f %d', d_records, d_mean/10, t_records)" 2>&1)
  [[ $found == "$(($(wc -l <run/csv/snapshot_0002.csv) - 1)) 100 3" ]] || { echo "# $found" && false; }
  ok $? "gnuplot: columns by name and unit"
else
  ok 0 "gnuplot # SKIP no gnuplot"
fi

"$sphode" export run --csv --vtu >out 2>err
[[ $? == 2 ]] && grep -q "one of --csv, --vtu, --gadget" err
ok $? "two formats at once"
"$sphode" export nowhere --csv >out 2>err
[[ $? == 1 && ! -e nowhere ]] && grep -q "nowhere: no such HDF5 file" err
ok $? "no run"

echo 1..$count
