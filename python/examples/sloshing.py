#!/usr/bin/env python3
"""sloshing -- a tank of water is shaken by a Python function, then left alone.

Equations  a_x += A sin(w t) for one period, w^2 = g k tanh(k H), k = pi/L: the first natural mode of
           a tank of length L filled to H; afterwards the water sloshes freely, with that period
Reference  H. Lamb (1932), Hydrodynamics, section 228
Run        python3 sloshing.py [L/dx, default 50] [picture, default sloshing.png]
See        sloshing.png: the pressure where the push ends, and where the middle of the water is over time
Check      the period of the free motion is that of the linear theory within 4 %

A notebook would have a cell where a line begins with "# ----".
"""
import math
import sys

import numpy as np

import sphode

# ---- the problem

L, H, g = 1.0, 0.5, 9.81  # tank, depth [m], [m/s^2]
across = int(sys.argv[1]) if len(sys.argv) > 1 else 50
picture = sys.argv[2] if len(sys.argv) > 2 else "sloshing.png"
dx, rho0, c0 = L / across, 1000.0, 10 * math.sqrt(g * H)
k = math.pi / L
w = math.sqrt(g * k * math.tanh(k * H))
period = 2 * math.pi / w


def shake(water):
    """Sideways, for one period."""
    if water.t < period:
        water.a[0] += 0.02 * g * math.sin(w * water.t)


# ---- the simulation

sim = sphode.Simulation(dim=2, dx=dx)
water = sim.box("water", (0, 0), (L, H), rho0)
tank = sim.walls("tank", (0, 0), (L, 2 * H), rho0)
water.eos = sphode.eos.tait(rho0, c0, 7)
tank.boundary = sphode.boundary.adami()
water.call("set_hydrostatic", 1, H, g)

term = sphode.term
sim.add(term.continuity(), term.pressure(), term.viscosity_artificial(0.01, 0),
        term.delta("antuono", 0.1), term.gravity((0, -g)), sphode.body(shake))
sim.integrator("erk:bogacki-shampine-4-2-3")

# ---- run: look at the middle of the water twenty times a period

times, middle, moment = [], [], None
for t in np.arange(0, 3.5 * period, period / 20):
    sim.run(t)
    x, y = water["position"]
    times.append(sim.time)
    middle.append(x.mean())
    if moment is None and t >= period:
        moment = sim.time, water.array("position"), water.array("pressure")

# ---- the period: where the middle crosses its mean, going to the right

times, middle = np.array(times), np.array(middle) - L / 2
free = times >= period
t, x = times[free], middle[free]
up = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))
crossings = t[up] - x[up] * (t[up + 1] - t[up]) / (x[up + 1] - x[up])
measured = np.diff(crossings).mean()
off = measured / period - 1
print(f"{len(water)} particles, {sim.stats.step.steps} steps: period {measured:.4f} s, "
      f"linear theory {period:.4f} s ({100 * off:+.2f} %)")

# ---- the picture

try:
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError:
    print("no picture: matplotlib is missing (Debian: python3-matplotlib)")
else:
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4), constrained_layout=True)
    shown, position, pressure = moment
    dots = left.scatter(*position.T, c=pressure / 1000, s=(220 * dx / L) ** 2 / 2, lw=0)
    left.plot([0, 0, L, L], [1.5 * H, 0, 0, 1.5 * H], color="black")
    left.set(title=f"t = {shown:.2f} s: the push ends", xlabel="x [m]", ylabel="y [m]", aspect="equal")
    figure.colorbar(dots, label="pressure [kPa]", shrink=0.8)
    right.axvspan(0, period, color="0.9", label="pushed")
    right.plot(times, 1000 * middle, ".-", label="sphode")
    right.plot(crossings, 0 * crossings, "o", mfc="none", color="black",
               label=f"crossings: period {measured:.3f} s, theory {period:.3f} s")
    right.set(xlabel="t [s]", ylabel="middle of the water - L/2 [mm]")
    right.set_ylim(top=1.9 * 1000 * middle.max())  # room for the legend
    right.legend(loc="upper left")
    figure.savefig(picture, dpi=110)
    print(f"picture: {picture}")

sys.exit(0 if abs(off) < 0.04 else 1)
