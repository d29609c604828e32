#!/usr/bin/env bash
# Other tools' own readers open what a run and `sphode export` write, and find the same numbers:
# h5py and yt (snapshots, GADGET's layout), VTK (VTU; VTKHDF), ParaView (series), SPLASH, gnuplot (CSV);
# and files that VTK itself wrote come in.  A reader that is not here is skipped; Debian: python3-h5py,
# python3-yt, python3-vtk9 or paraview, splash, gnuplot-nox.
source "$SRCDIR/tests/tap.sh"

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
for format in csv vtu gadget splash; do "$sphode" export run --$format -q || break; done
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

read_by "VTK: VTKHDF of the snapshots themselves, their series, fields with units" vtk <<'END'
import json, vtk
from vtk.util.numpy_support import vtk_to_numpy as numbers
times = [float(line.split(",")[1]) for line in open("run/csv/times.csv") if line[0] == "s"]
for base in "snapshot", "walls":
    files = json.load(open(f"run/{base}.hdf.series"))["files"]
    assert [f["name"] for f in files] == [f"{base}_{k:04}.hdf" for k in range(3)]
    for entry, time in zip(files, times):
        assert abs(entry["time"] - time) <= 1e-14 * time, entry
        other = vtk.vtkXMLUnstructuredGridReader()
        other.SetFileName("run/vtu/" + entry["name"].replace("hdf", "vtu"))
        reader = vtk.vtkHDFReader()
        reader.SetFileName("run/" + entry["name"])
        for r in (reader, other):
            r.Update()
        a, b = reader.GetOutput(), other.GetOutput()
        assert a.GetNumberOfPoints() == b.GetNumberOfPoints() >= 50
        assert (numbers(a.GetPoints().GetData()) == numbers(b.GetPoints().GetData())).all()
        names = {"Pressure [Pa]": "pressure [Pa]", "Velocities [m per s]": "velocity [m/s]",
                 "Density [kg per m^3]": "density [kg/m^3]", "Masses [kg per m]": "mass [kg/m]",
                 "SoundSpeed [m per s]": "sound_speed [m/s]", "InternalEnergy [J per kg]": "energy [J/kg]",
                 "SmoothingLength [m]": "smoothing_length [m]", "ParticleIDs": "id", "Group": "group"}
        found = [a.GetPointData().GetArrayName(k) for k in range(a.GetPointData().GetNumberOfArrays())]
        assert set(found) <= set(names) and (base == "walls" or set(found) == set(names)), found
        for n in found:
            assert (numbers(a.GetPointData().GetArray(n)) == numbers(b.GetPointData().GetArray(names[n]))).all(), n
print("right")
END

# ParaView's own reader of series, without a window.
if command -v pvpython >/dev/null; then
  cat >series.py <<'END'
from paraview.simple import OpenDataFile
from paraview.servermanager import Fetch
times = [float(line.split(",")[1]) for line in open("run/csv/times.csv") if line[0] == "s"]
for name in "run/snapshot.hdf.series", "run/walls.hdf.series", "run/vtu/snapshot.pvd", "run/vtu/walls.pvd":
    source = OpenDataFile(name)
    found = list(source.TimestepValues)
    assert len(found) == 3 and all(abs(a - b) <= 1e-14 * b for a, b in zip(found, times)), (name, found)
    tops = []
    for time in found:
        source.UpdatePipeline(time)
        grid = Fetch(source)
        tops.append(grid.GetPointData().GetArray("Pressure [Pa]" if "hdf" in name else "pressure [Pa]").GetRange())
    assert len(set(tops)) == 3, (name, tops)
print("right")
END
  pvpython --force-offscreen-rendering series.py >out 2>&1 && [[ $(tail -n 1 out) == right ]] || { sed 's/^/# /' out && false; }
  ok $? "ParaView: series open at the times of the run"
else
  ok 0 "ParaView: series # SKIP no pvpython"
fi

# SPLASH finds coordinates, velocity, density, mass, h and the time by itself, and reads all digits.
if command -v splash >/dev/null; then
  (cd run/splash && splash to ascii -f ascii snapshot_0002.txt </dev/null) >out 2>&1
  missing=
  for said in "Assuming 2 dimensions, coords in cols  1 to  2" "density in column  5, mass in  9, h in 11" \
    "velocity in cols  3 to  4" "thermal energy in  6" "pressure in column 10"; do
    grep -q "$said" out || missing=$said
  done
  [[ -z $missing ]] &&
    awk 'NR == FNR { if (/^#/) { if (NR == 2) time = $2 } else for (k = 1; k <= NF; k++) right[FNR - 4, k] = $k; next }
      /^#/ { if (++heads == 4 && ($2 - time)^2 > 1e-14 * time^2) bad = 1; next }
      { rows++; for (k = 1; k <= NF; k++) { e = $k - right[rows, k]; if (e * e > 1e-29 * $k^2) bad = 1 } }
      END { exit bad || rows != 50 || heads < 8 }' run/splash/snapshot_0002.txt run/splash/snapshot_0002.txt.ascii
  status=$?
  ((status)) && echo "# not said: $missing" && sed 's/^/# /' out
  ok $status "SPLASH: columns, time and digits"
else
  ok 0 "SPLASH # SKIP no splash"
fi

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

# The same by sphode.yt: nothing to be told; groups by their names.
library=$(sed -n "s/^dlname='\(.*\)'/\1/p" "$BUILDDIR/libsphode.la")
SPHODE_LIBRARY=$BUILDDIR/.libs/$library SPHODE_DECLARATIONS=$BUILDDIR/declarations.h PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$SRCDIR/python:$PYTHONPATH \
  read_by "yt: sphode.yt.load" yt <<'END'
import h5py, yt
yt.set_log_level("critical")
try:
    import sphode.yt
except ImportError as error:  # cffi is not there
    print("right" if "cffi" in str(error) else error)
    raise SystemExit
for name in ("run/snapshot_0002.hdf", "run/gadget/snapshot_0002.hdf5"):
    ds = sphode.yt.load(name)
    data, right = ds.all_data(), h5py.File(name)
    fluid, walls = right["PartType0"], right["PartType1"]
    group = "water" if "Groups" in right else "PartType0"
    assert len(data[group, "mass"]) == len(fluid["Masses"]) and len(data["PartType1", "mass"]) == len(walls["Masses"])
    for field, dataset, column, unit in (("pressure", "Pressure", None, "Pa"), ("density", "Density", None, "kg/m**3"), ("velocity_y", "Velocities", 1, "m/s"),
                                         ("sound_speed", "SoundSpeed", None, "m/s"), ("energy", "InternalEnergy", None, "J/kg"), ("mass", "Masses", None, "kg")):
        found, wanted = sorted(data[group, field].to(unit).d), fluid[dataset][()]
        wanted = sorted(wanted if column is None else wanted[:, column])
        assert max(abs(p - q) for p, q in zip(found, wanted)) <= 1e-12 * max(map(abs, wanted)), field
    low, high = ds.domain_left_edge.to("m").d, ds.domain_right_edge.to("m").d
    for part in fluid, walls:
        assert (part["Coordinates"][()] > low).all() and (part["Coordinates"][()] < high).all()
    assert not any(ds.periodicity) and abs(float(ds.current_time.to("s")) - right["Header"].attrs["Time"]) < 1e-9
    energy = float((data[group, "particle_mass"] * data[group, "particle_velocity_magnitude"] ** 2).sum().to("J")) / 2
    assert abs(energy / (sum(fluid["Masses"][()] * (fluid["Velocities"][()] ** 2).sum(axis=1)) / 2) - 1) < 1e-12
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

# Initial conditions that VTK's own writers wrote, in each way that they know.
sed -e 's/start.hdf5/start.vtu/; s/dimension: 3/dimension: 2/; s|ideal-gas: {gamma: 1.4}|linear: {sound_speed: 10 m/s}|' case.yml >vtu.yml
read_by "VTK: initial conditions come in" vtk <<END
import subprocess, sys, vtk
sys.path.insert(0, "$SRCDIR/tests/data/vtu")
sys.dont_write_bytecode = True
import glob, make, os
os.makedirs("ways")
make.all_ways("ways")
ways = glob.glob("ways/*")
assert len(ways) == 40
for way in ways:
    text = open("vtu.yml").read().replace("start.vtu", way)
    open("way.yml", "w").write(text)
    said = subprocess.run(["$sphode", "run", "way.yml", "-q", "-f", "-o", "way"], capture_output=True, text=True).stderr
    if "libexpat1-dev" in said:
        break
    reader = vtk.vtkHDFReader()
    reader.SetFileName("way/snapshot_0000.hdf")
    reader.Update()
    grid = reader.GetOutput()
    assert grid and grid.GetNumberOfPoints() == make.N, (way, said)
    small = 3e-8 if "single" in way else 1e-16
    for i in range(make.N):
        x = grid.GetPoint(i)
        assert abs(x[0] - 0.1 * (i % 4)) <= small and abs(x[1] - 0.1 * (i // 4)) <= small, way
        assert grid.GetPointData().GetArray("Velocities [m per s]").GetTuple(i) == (i, -0.5 * i, 0), way
        assert grid.GetPointData().GetArray("Density [kg per m^3]").GetValue(i) == 1000 + 0.25 * i, way
        assert grid.GetPointData().GetArray("Masses [kg per m]").GetValue(i) == 10 + i, way
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

"$sphode" export run --format splash,csv,vtu -o both -q >out 2>err &&
  for format in csv vtu splash; do diff -r -x "*.ascii" run/$format both/$format || break; done && [[ $(ls both | wc -l) == 3 ]]
ok $? "several formats at once, each in its folder"
"$sphode" export run --csv --splash -q -o two && [[ $(ls two | tr '\n' ' ') == "csv splash " ]]
ok $? "... by options of their own"
for wrong in csv,vt "" csv,, ,; do
  "$sphode" export run --format "$wrong" >out 2>err
  [[ $? == 2 ]] && grep -q "wants some of csv, vtu, gadget, splash" err || break
done && "$sphode" export run >out 2>err
[[ $? == 2 ]] && grep -q "export: --format wants some of" err
ok $? "formats that are none"
"$sphode" export nowhere --csv >out 2>err
[[ $? == 1 && ! -e nowhere ]] && grep -q "nowhere: no such HDF5 file" err
ok $? "no run"

echo 1..$count
