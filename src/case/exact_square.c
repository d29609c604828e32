/* A square of inviscid liquid, side L, in the moment when it begins to turn clockwise,
 * v = omega (y, -x): inside laplace p = 2 rho omega^2, on the sides p = 0 (Colagrossi 2005).  With
 * x, y from the centre along the sides,
 *
 *   p/(rho omega^2) = x^2 - L^2/4
 *       + (8 L^2/pi^3) sum_{n odd} (-1)^((n-1)/2) cos(n pi x/L) cosh(n pi y/L)/(n^3 cosh(n pi/2)),
 *
 * the sum over m of the double series -32/(m n pi^2 ((m pi/L)^2 + (n pi/L)^2)) sin sin, done.
 * As long as it is a square it turns as a whole, by the angle omega t. */
#include <math.h>

#include "exact.h"

static const double pi = 3.14159265358979323846;
enum { LAST = 199 }; /* what is left out: 8/pi^3 sum_{n > 199} n^-3 = 3e-6 L^2, on the sides */

/* cosh(a)/cosh(b), |a| <= b, without overflow. */
static double cosh_ratio(double a, double b)
{
  return (exp(fabs(a) - b) + exp(-fabs(a) - b)) / (1 + exp(-2 * b));
}

double sph_exact_square_pressure(const sph_exact_square *square, double t, double x, double y)
{
  const double L = square->side, c = cos(square->omega * t), s = sin(square->omega * t);
  const double u = c * x - s * y, v = s * x + c * y; /* turned back */
  if (fabs(u) >= L / 2 || fabs(v) >= L / 2) return 0;
  double sum = 0, sign = 1;
  for (int n = 1; n <= LAST; n += 2, sign = -sign)
    sum +=
        sign * cos(n * pi * u / L) * cosh_ratio(n * pi * v / L, n * pi / 2) / ((double)n * n * n);
  return square->rho * square->omega * square->omega *
         (u * u - L * L / 4 + 8 * L * L / (pi * pi * pi) * sum);
}
