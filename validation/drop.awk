# Semi-axes of an elliptical drop over time, against which runs are drawn: t, a, b, in units of its radius.  -v omega of the central
# force [1/s], rate of strain at the start [1/s], end [s].  A' = (A^2 + omega^2)(b^2 - a^2)/(a^2 + b^2), a' = A a, b = 1/a.
function slope(A, a) { return (A * A + omega * omega) * (1 - a^4) / (1 + a^4) }
BEGIN {
  n = 2000; dt = end / n; A = rate; a = 1
  for (k = 0; k <= n; k++) {
    print k * dt "," a "," 1 / a
    A1 = slope(A, a); a1 = A * a
    A2 = slope(A + dt / 2 * A1, a + dt / 2 * a1); a2 = (A + dt / 2 * A1) * (a + dt / 2 * a1)
    A3 = slope(A + dt / 2 * A2, a + dt / 2 * a2); a3 = (A + dt / 2 * A2) * (a + dt / 2 * a2)
    A4 = slope(A + dt * A3, a + dt * a3); a4 = (A + dt * A3) * (a + dt * a3)
    A += dt / 6 * (A1 + 2 * A2 + 2 * A3 + A4); a += dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
  }
}
