/* 13_operators -- derivatives of a field on your own points: which operator, and how far it is off.
 *
 * Equations  grad f = sum V_j (f_j - f_i) grad W and its corrected form M^-1 times it;
 *            lap f = 2 sum V_j (f_i - f_j) F and that of Fatehi and Manzari; moving least squares
 *            of order 2; for f = sin(2 pi x) cos(2 pi y) on a square whose points are shaken
 * Reference  J. Bonet & T.-S. L. Lok (1999), Comput. Methods Appl. Mech. Eng. 180, 97;
 *            R. Fatehi & M. T. Manzari (2011), Comput. Math. Appl. 61, 482
 * Run        ./13_operators [points across]
 * See        root mean square errors over the size of the exact result, for twice as many points
 *            again and again at h = 2.2 dx, and the order: those that are not corrected stay where
 *            they are or grow; the field between the points, along a line
 * Check      corrected gradient and least squares are of order 1 at least, also at the faces of
 *            the square; the field of the line is within 1e-3 */
#include <math.h>
#include <sphode.h>
#include <stdlib.h>

enum { OPERATORS = 5, LEVELS = 4, LINE = 11 };
static const char *const name[OPERATORS] = {"gradient, difference", "gradient, corrected",
                                            "laplacian, arithmetic", "laplacian, fatehi-manzari",
                                            "mls 2, second derivative xx"};

typedef struct points {
  long n;
  double *x, *y, *volume, *f, *exact[3]; /* df/dx, lap f, d2f/dx2 */
  double *out[3];
} points;

/* Between -1 and 1; the same everywhere. */
static double noise(void)
{
  static unsigned state = 1;
  state = state * 1664525u + 1013904223u;
  return (state >> 8) / 8388608.0 - 1;
}

static double *array(long n)
{
  double *a = calloc((size_t)n, sizeof *a);
  if (!a) fprintf(stderr, "13_operators: out of memory\n"), exit(1);
  return a;
}

static double field(double x, double y, double k) { return sin(k * x) * cos(k * y); }

static points make(int across)
{
  const double dx = 1.0 / across, k = 2 * acos(-1);
  points p = {.n = (long)across * across};
  double **all[] = {&p.x,        &p.y,        &p.volume, &p.f,      &p.exact[0],
                    &p.exact[1], &p.exact[2], &p.out[0], &p.out[1], &p.out[2]};
  for (int a = 0; a < 10; a++) *all[a] = array(p.n);
  for (long i = 0; i < p.n; i++) {
    p.x[i] = dx * ((double)(i % across) + 0.5 + 0.2 * noise());
    p.y[i] = dx * ((double)(i / across) + 0.5 + 0.2 * noise());
    p.volume[i] = dx * dx;
    p.f[i] = field(p.x[i], p.y[i], k);
    p.exact[0][i] = k * cos(k * p.x[i]) * cos(k * p.y[i]);
    p.exact[1][i] = -2 * k * k * p.f[i];
    p.exact[2][i] = -k * k * p.f[i];
  }
  return p;
}

static void drop(points *p)
{
  double *all[] = {p->x,        p->y,        p->volume, p->f,      p->exact[0],
                   p->exact[1], p->exact[2], p->out[0], p->out[1], p->out[2]};
  for (int a = 0; a < 10; a++) free(all[a]);
}

/* sqrt(mean (out - exact)^2/mean exact^2) */
static double off(const points *p, const double *out, const double *exact)
{
  double sum = 0, size = 0;
  for (long i = 0; i < p->n; i++) {
    sum += pow(out[i] - exact[i], 2);
    size += pow(exact[i], 2);
  }
  return sqrt(sum / size);
}

/* Operators on the points; NULL: error says why. */
static sph_operator *operators(const points *p, int across, sph_error *error)
{
  const double *const x[] = {p->x, p->y};
  sph_operator *op =
      sph_operator_create(&(sph_operator_def){.dim = 2, .h = 2.2 / across, .threads = 2}, error);
  if (!sph_operator_set_points(op, p->n, x, p->volume, NULL, error)) return op;
  sph_operator_free(op);
  return NULL;
}

static void measure(int across, double error_of[OPERATORS], sph_error *error)
{
  points p = make(across);
  sph_operator *op = operators(&p, across, error);
  for (int form = 0; form < 2; form++) {
    sph_operator_gradient(op, form ? "corrected" : "difference", p.f, p.out, error);
    error_of[form] = off(&p, p.out[0], p.exact[0]);
    sph_operator_laplacian(op, form ? "fatehi-manzari" : "arithmetic", NULL, p.f, p.out[0], error);
    error_of[2 + form] = off(&p, p.out[0], p.exact[1]);
  }
  sph_operator_mls(op, 2, p.f, NULL, NULL, p.out, error);
  error_of[4] = off(&p, p.out[0], p.exact[2]);
  sph_operator_free(op);
  drop(&p);
}

/* Values between the points; returns the largest error. */
static double line(int across, sph_error *error)
{
  points p = make(across);
  double x[LINE], y[LINE], shepard[LINE], mls[LINE], worst = 0;
  const double *const at[] = {x, y}, k = 2 * acos(-1);
  for (int i = 0; i < LINE; i++) x[i] = 0.1 * i, y[i] = 0.04 + 0.02 * i;
  sph_operator *op = operators(&p, across, error);
  sph_operator_set_probes(op, LINE, at, error);
  sph_operator_shepard(op, p.f, shepard, error);
  sph_operator_mls(op, 2, p.f, mls, NULL, NULL, error);
  printf("\n%8s %8s %12s %12s %12s\n", "x [m]", "y [m]", "exact", "shepard", "mls 2");
  for (int i = 0; i < LINE; i++) {
    const double exact = field(x[i], y[i], k);
    printf("%8.2f %8.2f %12.5f %12.5f %12.5f\n", x[i], y[i], exact, shepard[i], mls[i]);
    worst = fmax(worst, fabs(mls[i] - exact));
  }
  sph_operator_free(op);
  drop(&p);
  return worst;
}

int main(int argc, char **argv)
{
  const int across = argc > 1 ? atoi(argv[1]) : 24;
  double e[LEVELS][OPERATORS];
  sph_error error = {0};
  int failed = 0;
  printf("%-28s", "points across");
  for (int l = 0; l < LEVELS; l++) {
    measure(across << l, e[l], &error);
    printf(" %10d", across << l);
  }
  printf(" %8s\n", "order");
  for (int o = 0; o < OPERATORS; o++) {
    const double order = log2(e[LEVELS - 2][o] / e[LEVELS - 1][o]);
    printf("%-28s", name[o]);
    for (int l = 0; l < LEVELS; l++) printf(" %10.2e", e[l][o]);
    printf(" %8.2f\n", order);
    if (o % 2 == 1 || o == 4) failed |= !(order > 0.9);
  }
  const double worst = line(across << 2, &error);
  printf("largest error of mls 2: %.1e\n", worst);
  if (error.status) fprintf(stderr, "13_operators: %s\n", error.text);
  return failed || !(worst < 1e-3) || error.status;
}
