# The table of validations, read by validation/validate, which says what its words mean: one entry a page of docs/validation,
# in the order of the front page.  Bars stand in the case files and in the tests; `because` tells why one is missed.

group "Operators and right-hand side"

page kernels "tests: Kernels" kernels
tests unit/test_kernel "every kernel in every dimension: table; integral; derivative" "table; quadrature, differentiation (GSL)" "1e-12; 1e-10; 1e-8"

page operators "tests: Operators: what they reproduce exactly, and their orders" operators
tests property/test_operator_exact "constants, lines, parabolas on jittered points" "polynomials" "1e-11 of the sum of absolute values"
tests accuracy/test_operator_orders "orders on lattices and jittered points" "analysis" "± 0.15 of the order expected"

page conservation "tests: What the right-hand side keeps" right-hand-side
tests property/test_conservation "momentum, angular momentum, energy of every pair term; heating; entropy" "conservation laws" "1e-13; signs exact"
tests property/test_conservation_terms "the same of the other fluid terms" "conservation laws" "1e-13; signs exact"
tests property/test_rhs "right-hand side, random states" "brute force in long double" "1e-14 of the sum of absolute values"

page viscosity "tests: Effective viscosity on a lattice" terms
tests accuracy/test_viscosity "Morris in 2D, effective over nominal viscosity" "shear flow" "within 0.5 %" \
  '2D, 100 across, h = 1.5 dx: Morris \([0-9.]*\)' "100 across, h = 1.5 dx"

page lattice-sound "tests: Sound on a lattice" exact-solutions
tests accuracy/test_acoustics "frequency of lattice waves, all kernels" "discrete dispersion relation" "1e-9"

page jacobians "tests: Jacobians and tangents" derivatives
tests property/test_jacobian "sparse Jacobian" "central differences" "1e-6"
tests property/test_tangent "tangents of f" "central differences" "1e-6"

page riemann "tests: The exact Riemann solver" exact-solutions
tests unit/test_exact "star values of Sod's and of Toro's tests" "published values" "1e-9"

group "Incompressible and free-surface flow"

page couette couette-2d terms
runs "h/dx = 1.5" parameters.n "25 50 100"
judge 50
picture 50 compare_0 "velocities of all particles and the series at five times"
runs "h/dx = 2" parameters.n "25 50 100" --set kernel.h_over_dx=2
judge 50
tests accuracy/test_channel "Couette and Poiseuille: orders at early times, and with h/dx growing" "exact series" "≥ 1; ≥ 1.5 in h"

page poiseuille poiseuille-2d terms
runs "h/dx = 1.5" parameters.n "25 50 100"
judge 50
picture 50 compare_0 "velocities of all particles and the series at five times"
runs "h/dx = 2" parameters.n "25 50 100" --set kernel.h_over_dx=2 --set compare.0.bar=0.0015
judge 50
say "At a fixed h/dx a floor of about 0.3 % remains, the error of the Laplacian on a lattice: the order is one of h, told by" \
  "the test on the page [couette](couette.md)."

page taylor-green taylor-green-2d terms
runs "Jittered start, no shifting" parameters.dx "L/25 L/50 L/100"
judge L/50
picture L/50 compare_0 "velocities of all particles over the exact ones at three times"

page taylor-green-shifted taylor-green-shifted-2d terms
runs "Shifting" parameters.dx "L/25 L/50 L/100" --set compare.0.bar=0.001 --set compare.1.bar=0.005
judge L/100
order velocity 1.7
picture L/100 compare_0 "velocities of all particles over the exact ones at the end"
say "The rate of decay is that of the kernel's Laplacian, which is smaller than the exact one by the factor 1 - sigma^2 h^2 |k|^2/4, sigma^2 = 5/18 and" \
  "|k|^2 = 2 k^2: 0.965, 0.9912 and 0.9978 with these spacings. That is why the 0.5 % asked of it are asked of L/100."
runs "Shifting, 50 x 50 against its bar" parameters.dx "L/50"
judge L/50 '^velocity'
tests accuracy/test_taylor_green_shifted "transport velocity: mean velocity error, % of U" "exact solution" "≤ 0.3" \
  'transport velocity, 50 x 50: mean velocity error \([0-9.]*\)' "dx = L/50"
runs "Gradients not corrected, sound at 10 U" parameters.dx "L/25 L/50 L/100" --set "groups.water.eos.tait.sound_speed=10*U" \
  --set terms.continuity.correction=none --set terms.pressure.correction=none --set terms.viscosity-laminar.correction=none
say "Sums of a continuity that is not corrected rise where a flow disorders the particles, and fall where shifting orders them: from this start the mean" \
  "density falls by 0.3 % in the first moments, and the viscous force, which goes as its inverse square, is 0.7 % too large from then on: some of what the" \
  "kernel's Laplacian lacks. Faster sound makes the errors of such gradients larger (0.0072 with L/50 and 20 U), those of corrected ones smaller."

page lid-driven-cavity lid-driven-cavity-2d walls
runs "Re = 100" parameters.n "25 50 100"
combined "velocities on both centre lines" 50 0.018
combined "velocities on both centre lines" 100 0.010
picture 100 compare_0 "velocity along the vertical centre line, mean over 16 to 20 L/U"
picture 100 compare_1 "velocity along the horizontal centre line, mean over 16 to 20 L/U"
picture 100 frames "velocity along x"
runs "Re = 400" parameters.n "25 50" --set parameters.Re=400 --set "run.end=40*L/U" \
  --set compare.0.reference.section.file=../data/ghia_1982_re400_u.csv --set "compare.0.window=[36, 40]" \
  --set compare.1.reference.section.file=../data/ghia_1982_re400_v.csv --set "compare.1.window=[36, 40]"
combined "velocities on both centre lines" 50 0.03
say "Nobody gave a bar for Re = 400: it is what was measured. The layers at the walls are as thin as h here; the error falls by 2.8 from 25 to 50."
picture 50 compare_0 "velocity along the vertical centre line, Re = 400, mean over 36 to 40 L/U"
runs "Re = 100, gradients not corrected" parameters.n "25 50" \
  --set terms.continuity.correction=none --set terms.pressure.correction=none --set terms.viscosity-laminar.correction=none

page hydrostatic hydrostatic-tank-2d walls
runs "Diffusion of Antuono, H/dx = 20" run.end "10*T 60*T 120*T"
judge 120*T '^pressure'
judge 60*T '^kinetic'
curves kinetic "Kinetic energy, diffusion of Antuono" 'column("time [s]")*sqrt(9.81)' 'column("kinetic [J/m]")/(1000*9.81)' \
  'set logscale y' 'set format y "10^{%L}"' 'set yrange [1e-9:]' 'set xlabel "t sqrt(g/H)"' 'set ylabel "kinetic energy/(rho g H^3)"'
runs "Diffusion of Fourtakas, walls that may pull" run.end "10*T 60*T 120*T" --set terms.delta.model=fourtakas --set groups.tank.boundary.tension=true
judge 120*T '^pressure'
runs "Diffusion of Molteni: its drift" run.end "10*T 60*T" --set terms.delta.model=molteni
runs "Dynamic boundary particles (dbc): their drift" run.end "10*T 60*T" --set groups.tank.boundary.model=dbc

page standing-wave standing-wave-2d terms
runs "Re = 50" parameters.dx "H/20 H/40"
judge H/40
curves momentum "Momentum along the tank" 'column("time [s]")' 'column("momentum_x [kg/s]")' \
  'set xlabel "time [s]"' 'set ylabel "momentum along x [kg/s]"' \
  'set samples 800' 'set dummy x' 'w = sqrt(9.81*pi*tanh(pi))' \
  '2000*0.02*w/pi**2*cos(w*(1 - sqrt(2)*0.02**1.5)*x)*exp(-2*0.02*w*(1 - sqrt(0.01))*x) with lines lc "black" dt 2 title "linear theory"'
runs "Re = 200, eight periods: more of the damping is numerical" parameters.dx "H/20" --set parameters.q=0.005 --set "run.end=8*T"

page oscillating-drop oscillating-drop-2d exact-solutions
runs "Artificial viscosity, alpha = 0.02" parameters.dx "R/20"
judge R/20
runs "No viscosity, corrected gradients" parameters.dx "R/10 R/20 R/40" --set terms.viscosity-artificial.alpha=0 --set compare.0.bar=2e-3 --set compare.1.bar=2e-3 \
  --set terms.continuity.correction=one-sided --set terms.pressure.correction=mean
judge R/20
curves axes "Semi-axis along x, no viscosity" 'column("time [s]")' 'column("a [m]")' 'set xlabel "time [s]"' 'set ylabel "a [m]"'
picture R/20 frames "pressure"
runs "No viscosity" parameters.dx "R/10 R/20 R/40" --set terms.viscosity-artificial.alpha=0
runs "The same, h/dx = 2.8" parameters.dx "R/20 R/40" --set terms.viscosity-artificial.alpha=0 --set kernel.h_over_dx=2.8
runs "The same, h/dx = 2, sound 1.4 times as fast" parameters.dx "R/20 R/40" --set terms.viscosity-artificial.alpha=0 --set "groups.drop.eos.tait.sound_speed=20*R*omega"
say "At a fixed h/dx the error settles at about 0.002, that of sums over disordered particles, which is one of h/dx ([consistency.md](../consistency.md)), and R/40 is no" \
  "better than R/20. With h/dx growing as dx^(-1/2), from 2 at R/20 to 2.8 at R/40, it falls from 0.0018 and 0.0022 to 0.0005 and 0.0007. The speed of sound is not the" \
  "reason, nor is the start: the particles of a lattice inside the disc have semi-axes 1.0025 R with R/20, 0.9993 R with R/40."
tests accuracy/test_drop "both semi-axes over those of the start, no viscosity, sound 20" "exact solution" "≤ 2e-3" \
  'alpha = 0: error of the semi-axes \([0-9.]*\)' "R/dx = 20"
tests accuracy/test_drop "the same, alpha = 0.02, corrected gradients" "exact solution" "≤ 7e-3" \
  'alpha = 0.02, corrected: error of the semi-axes \([0-9.]*\)' "R/dx = 20"

page elliptical-patch elliptical-patch-2d exact-solutions
runs "h/dx = 2.5" parameters.dx "R/20 R/40"
judge R/20
picture R/20 frames "pressure"

page rotating-square rotating-square-2d exact-solutions
runs "Exact pressure at the start" parameters.n "25 50 100"
judge 50 '^pressure$'
picture 50 compare_0 "pressures of all particles over the exact ones at five times"
runs "No pressure at the start" parameters.n "25 50 100" --set parameters.start=0
judge 50 centre
curves centre "Pressure in the centre, no pressure at the start" 'column("time [s]")' 'column("centre [Pa]")/1000' \
  'set xlabel "time [1/omega]"' 'set ylabel "p/(rho omega^2 L^2)"' '-0.1473427 with lines lc "black" dt 2 title "exact"'
runs "Slower sound, until 1/omega" parameters.n "25 50" --set parameters.start=0 --set "parameters.c=10*omega*L" --set run.end=1/omega
judge 50 angular
say "In the last set only the angular momentum is of use: the square is none any more."

page dam-break-front dam-break-2d walls
runs "To T = 9.4" parameters.dx "H/40 H/80"
judge H/80 '^front, '
picture H/80 compare_1 "front against Martin & Moyce, 2.25 in, with the offset fitted"
picture H/80 frames "speed"
runs "Convergence at T = 2" parameters.dx "H/40 H/80 H/160" --set "run.end=2.2*T"
judge H/80 'T = 2'
judge H/160 'T = 2'
settles "front at T = 2"

page dam-break-pressure dam-break-2d-impact walls
because '^pressure' "most of the distance lies between 2.4 and 3, where the pressure rises later than measured"
runs "h/dx = 1.5" parameters.dx "H/40 H/80"
judge H/80
curves pressure "Pressure on the far wall, y = 0.2 H, unfiltered" 'column("time [s]")/sqrt(0.6/9.81)' 'column("p1 [Pa]")/(1000*9.81*0.6)' \
  'set xlabel "t sqrt(g/H)"' 'set ylabel "p/(rho g H)"' 'set yrange [-0.2:1.2]' \
  '"data/buchner_2002_p1.csv" using 1:2 with points pt 7 ps 0.7 lc "black" title "Buchner (2002)"'
say "Every point of the experiment counts once; a quarter of them crowd between 2.4 and 2.7, where the pressure rises. The row 'the same, over time' lets each" \
  "count for the time that it stands for; it has no bar."
say "The ringing is sound between the wall and the surface; the rows above take the mean over 0.1, which is what such a ring lasts."
picture H/80 frames "pressure"
runs "Only from 3 on, when the pressure has risen" parameters.dx "H/40" --set "compare.0.window=[3, 5.4]"
runs "With the repulsion that walls have by default" parameters.dx "H/40 H/80" --set groups.tank.boundary.repulsion=0.4
say "The case does without that repulsion ([walls.md](../walls.md#impact)): particles that hit the wall bounce off it, and the pressure between 2.4 and 3.2 is" \
  "noisier, with tension down to -1. The less repulsion the nearer, at H/40: 0.163 with none, 0.207 with 0.05, 0.240 with 0.1, 0.277 with 0.4. The" \
  "arrival, of the pressure as it is, is told by such a peak. Without it water is pressed up to 0.7 spacings into the wall."

page dam-break-3d dam-break-3d-lobovsky walls
because impulse "after the impact the pressure is higher than measured; walls slip freely here, and with no slip it is too low"
runs "h/dx = 1.5, n = H/dx" parameters.n "10 20"
judge 20
curves pressure "Pressure on the far wall at P1, unfiltered" 'column("time [s]")/sqrt(0.3/9.81)' 'column("p1 [Pa]")/(1000*9.81*0.3)' \
  'set xlabel "t sqrt(g/H)"' 'set ylabel "p/(rho g H)"' \
  '"data/lobovsky_2014_p1.csv" using 1:2 with points pt 7 ps 0.7 lc "black" title "Lobovsky et al. (2014)"'
picture 20 frames "pressure"
runs "No slip, as far as artificial viscosity knows it" parameters.n 10 --set groups.tank.boundary.no_slip=true
case=dam-break-2d-impact
runs "The tank of Buchner (2002) in 2D, of the same proportions: its probe near the floor" parameters.dx "H/20" \
  --set "output.monitors.p1.at=[L, dx/2]" --set "output.monitors.p1.extent=[0, dx/2]"
say "After the impact, over 4.2 to 5.4, Lobovsky et al. measured 0.56 rho g H at the floor, Buchner 0.54 at 0.2 H, in tanks of the same" \
  "proportions. What lies between is 0.2 H of water: a run that meets Buchner's plateau, as the one in 2D does, has more at the floor than Lobovsky et al. measured." \
  "Slip at the walls changes most: without it the impulse is 38 % less at n = 10, too small. What a boundary layer at this scale does lies between, and is thinner than a spacing." \
  "Without the repulsion of the wall's particles water that falls back goes through the floor ([theory.md](../theory.md#walls)); it takes 1 % off the impulse." \
  "Finer runs in 3D take hours of a core: H/dx = 20 is what was affordable here."

page no-slip-walls "tests: No-slip walls: their order" walls
tests accuracy/test_wall_models "order between cylinders, one of them turning, Adami's walls" "steady flow" "≥ 1" \
  'between cylinders.*order \([0-9.]*\)' "h/dx = 1.5, 8 to 16 across"
tests accuracy/test_wall_models "order of a manufactured flow, Adami's walls" "its fields" "≥ 1" \
  'manufactured, adami.*order \([0-9.]*\)' "h/dx = 2, 16 to 32 across"
tests accuracy/test_wall_models "order of a manufactured flow, mirrors" "its fields" "≥ 1" \
  'manufactured, mirror, no slip, h.*order \([0-9.]*\)' "h/dx = 2, 16 to 32 across"
say "Finer ones, dynamic boundary particles and plates: [walls.md](../walls.md)."

elsewhere "Three wall models side by side, 10 s of impact, manufactured solutions" \
  "[walls.md](../walls.md), by \`make walls\`"

group "Compressible flow"

page acoustic-wave acoustic-wave-1d exact-solutions
runs "One period" parameters.n "32 64 128 256 512"
judge 128
order velocity 1.9
picture 128 compare_0 "velocities of all particles at four times"

page sod sod-1d exact-solutions
runs "Equal spacing, masses 8:1" parameters.n "100 200 400 800"
judge 400
picture 400 compare_0 "density"
picture 400 compare_1 "velocity"
tests accuracy/test_sod "plateaus of velocity, density and pressure, 400 particles" "exact solution" "2 %"

page heat-slab heat-slab-1d terms
runs "Implicit conduction" parameters.dx "L/50 L/100 L/200"
judge L/100
picture L/100 compare_0 "temperatures of all particles at four times"

page heat-two-media heat-two-media-1d terms
runs "Implicit conduction" parameters.dx "L/50 L/100 L/200"
judge L/100
picture L/100 compare_0 "temperatures of all particles at three times"

group "Time integration"

page order "tests: Orders of the integrators" time-integration
tests accuracy/test_order "every scheme on smooth SPH problems (Wendland C6)" "Richardson" "≥ order − 0.1"
tests accuracy/test_order_imex "implicit-explicit schemes" "Richardson" "≥ order − 0.1"
tests unit/test_integrator "every scheme on smooth ODEs; dense output" "exact solutions" "≥ order − 0.1"

elsewhere "work-precision diagrams" "published in [integrators.md](../integrators.md), by \`make work-precision\`; the recommended default is on their front"

page events "tests: Events" time-integration
tests unit/test_root "roots in the dense output of a step" "exact times" "1e-6 of a step"
tests property/test_events "events of runs" "exact times" "1e-6 of a step"

page restart "tests: Restart" time-integration
tests property/test_checkpoint "restarted = uninterrupted, every integrator, fixed and adaptive steps" "the uninterrupted run" "bitwise"
