#include "truncation.h"

#include <math.h>
#include <stdlib.h>

#include "cloud.h"

enum { ARRAYS = 9 };

/* f = 2 + sin(kx + .3) cos(ky - .2) cos(kz + .1) and u = (f(x, y, z), f(y, z, x), f(z, x, y)) with
 * all their derivatives; without cosines of missing directions.  The points have the density, and
 * what diffuses the conductivity, 4 - f. */
typedef struct field {
  cloud c;
  sph_operator *op;
  double *u[3], *G[3][3], *lap[3], *grad_div[3], *hessian[6];
  double *out[ARRAYS];
} field;

static const double shift[3] = {0.3, -0.2, 0.1};

/* Derivative of order n[d] along each direction of the product above, without the 2. */
static double product(int dim, const double *x, const int *n)
{
  const double k = 2 * acos(-1), quarter = acos(-1) / 2;
  double p = 1;
  for (int d = 0; d < dim; d++)
    p *= pow(k, n[d]) * sin(k * x[d] + shift[d] + quarter * (n[d] + (d > 0)));
  return p;
}

/* ... of component a of u, along directions b and c (-1: none). */
static double derivative(const field *w, int a, int b, int c, long i)
{
  const int dim = w->c.dim;
  double x[3];
  int n[3] = {0};
  for (int d = 0; d < dim; d++) x[d] = w->c.x[(d + a) % dim][i];
  for (int d = 0; d < dim; d++) n[d] += ((d + a) % dim == b) + ((d + a) % dim == c);
  return product(dim, x, n) + (b < 0 && c < 0 ? 2 : 0);
}

static void make_exact(field *w)
{
  const int dim = w->c.dim;
  for (long i = 0; i < w->c.n; i++)
    for (int a = 0, k = 0; a < dim; a++) {
      w->u[a][i] = derivative(w, a, -1, -1, i);
      for (int b = 0; b < dim; b++) {
        w->G[a][b][i] = derivative(w, a, b, -1, i);
        w->lap[a][i] += derivative(w, a, b, b, i);
        w->grad_div[a][i] += derivative(w, b, b, a, i);
        if (b >= a) w->hessian[k++][i] = derivative(w, 0, a, b, i);
      }
    }
}

static field make(int dim, int across, double h_over_dx, const char *kernel, double jitter)
{
  field w = {.c = cloud_make(dim, across, jitter, 1, 0)};
  for (long i = 0; i < w.c.n; i++) w.c.density[i] = 4 - derivative(&w, 0, -1, -1, i);
  w.op = cloud_operator(&w.c, (sph_operator_def){.h = h_over_dx / across, .kernel = kernel});
  for (int a = 0; a < 3; a++) {
    w.u[a] = cloud_array(w.c.n), w.lap[a] = cloud_array(w.c.n);
    w.grad_div[a] = cloud_array(w.c.n);
    for (int b = 0; b < 3; b++) w.G[a][b] = cloud_array(w.c.n);
  }
  for (int k = 0; k < 6; k++) w.hessian[k] = cloud_array(w.c.n);
  for (int k = 0; k < ARRAYS; k++) w.out[k] = cloud_array(w.c.n);
  make_exact(&w);
  return w;
}

static void drop(field *w)
{
  sph_operator_free(w->op);
  cloud_free(&w->c);
  for (int a = 0; a < 3; a++) {
    free(w->u[a]), free(w->lap[a]), free(w->grad_div[a]);
    for (int b = 0; b < 3; b++) free(w->G[a][b]);
  }
  for (int k = 0; k < 6; k++) free(w->hessian[k]);
  for (int k = 0; k < ARRAYS; k++) free(w->out[k]);
}

/* sqrt(sum |out - right|^2/sum |right|^2), of `count` arrays */
static double off(const field *w, int count, double *const *right)
{
  double sum = 0, size = 0;
  for (int k = 0; k < count; k++)
    for (long i = 0; i < w->c.n; i++) {
      sum += pow(w->out[k][i] - right[k][i], 2);
      size += pow(right[k][i], 2);
    }
  return sqrt(sum / size);
}

static const double *const *u_of(const field *w) { return (const double *const *)w->u; }

#define MEASURE(name, call, count, right) \
  static double name(field *w) { return (call) ? NAN : off(w, count, right); }

MEASURE(interpolate, sph_operator_interpolate(w->op, w->u[0], w->out[0], NULL), 1, w->u)
MEASURE(shepard, sph_operator_shepard(w->op, w->u[0], w->out[0], NULL), 1, w->u)
MEASURE(cspm, sph_operator_cspm(w->op, w->u[0], w->out[0], NULL, NULL), 1, w->u)
MEASURE(cspm_slope, sph_operator_cspm(w->op, w->u[0], w->out[8], w->out, NULL), w->c.dim, w->G[0])
MEASURE(mls_1, sph_operator_mls(w->op, 1, w->u[0], w->out[0], NULL, NULL, NULL), 1, w->u)
MEASURE(mls_1_slope, sph_operator_mls(w->op, 1, w->u[0], NULL, w->out, NULL, NULL), w->c.dim,
        w->G[0])
MEASURE(mls_2, sph_operator_mls(w->op, 2, w->u[0], w->out[0], NULL, NULL, NULL), 1, w->u)
MEASURE(mls_2_slope, sph_operator_mls(w->op, 2, w->u[0], NULL, w->out, NULL, NULL), w->c.dim,
        w->G[0])
MEASURE(mls_2_second, sph_operator_mls(w->op, 2, w->u[0], NULL, NULL, w->out, NULL),
        w->c.dim *(w->c.dim + 1) / 2, w->hessian)
#define GRADIENT(form)                                                                           \
  MEASURE(gradient_##form, sph_operator_gradient(w->op, #form, w->u[0], w->out, NULL), w->c.dim, \
          w->G[0])
GRADIENT(plain)
GRADIENT(difference)
GRADIENT(density)
GRADIENT(symmetric)
GRADIENT(plus)
GRADIENT(corrected)
static double velocity_gradient(field *w)
{
  if (sph_operator_gradient_vector(w->op, "corrected", u_of(w), w->out, NULL)) return NAN;
  double *right[ARRAYS];
  for (int a = 0; a < w->c.dim; a++)
    for (int b = 0; b < w->c.dim; b++) right[a * w->c.dim + b] = w->G[a][b];
  return off(w, w->c.dim * w->c.dim, right);
}
static double divergence(field *w)
{
  if (sph_operator_divergence(w->op, "difference", u_of(w), w->out[0], NULL)) return NAN;
  double *right = cloud_array(w->c.n);
  for (int a = 0; a < w->c.dim; a++)
    for (long i = 0; i < w->c.n; i++) right[i] += w->G[a][a][i];
  const double result = off(w, 1, &right);
  free(right);
  return result;
}
static double curl(field *w)
{
  if (w->c.dim == 1 || sph_operator_curl(w->op, "difference", u_of(w), w->out, NULL)) return NAN;
  double *right = cloud_array(w->c.n); /* the last component alone */
  if (w->c.dim == 3)
    for (long i = 0; i < w->c.n; i++) w->out[0][i] = w->out[2][i];
  for (long i = 0; i < w->c.n; i++) right[i] = w->G[1][0][i] - w->G[0][1][i];
  const double result = off(w, 1, &right);
  free(right);
  return result;
}
#define LAPLACIAN(name, form) \
  MEASURE(name, sph_operator_laplacian(w->op, form, NULL, w->u[0], w->out[0], NULL), 1, w->lap)
LAPLACIAN(lap_arithmetic, "arithmetic")
/* div(k grad f) = k lap f + grad k . grad f, k = 4 - f. */
static double lap_harmonic(field *w)
{
  if (sph_operator_laplacian(w->op, "harmonic", w->c.density, w->u[0], w->out[0], NULL)) return NAN;
  double *right = cloud_array(w->c.n);
  for (long i = 0; i < w->c.n; i++) {
    right[i] = w->c.density[i] * w->lap[0][i];
    for (int b = 0; b < w->c.dim; b++) right[i] -= w->G[0][b][i] * w->G[0][b][i];
  }
  const double result = off(w, 1, &right);
  free(right);
  return result;
}
LAPLACIAN(lap_corrected, "corrected")
LAPLACIAN(lap_fatehi, "fatehi-manzari")
MEASURE(grad_div, sph_operator_grad_div(w->op, u_of(w), w->out, NULL), w->c.dim, w->grad_div)
static double mcg(field *w)
{
  if (sph_operator_mcg(w->op, u_of(w), w->out, NULL)) return NAN;
  double *right[3] = {NULL, NULL, NULL};
  for (int a = 0; a < w->c.dim; a++) {
    right[a] = cloud_array(w->c.n);
    for (long i = 0; i < w->c.n; i++) right[a][i] = w->lap[a][i] + 2 * w->grad_div[a][i];
  }
  const double result = off(w, w->c.dim, right);
  for (int a = 0; a < w->c.dim; a++) free(right[a]);
  return result;
}

static const struct {
  const char *name;
  double (*measure)(field *w);
} all[] = {{"interpolate", interpolate},
           {"shepard", shepard},
           {"cspm", cspm},
           {"mls 1", mls_1},
           {"mls 2", mls_2},
           {"gradient plain", gradient_plain},
           {"gradient difference", gradient_difference},
           {"gradient density", gradient_density},
           {"gradient symmetric", gradient_symmetric},
           {"gradient plus", gradient_plus},
           {"gradient corrected", gradient_corrected},
           {"gradient cspm", cspm_slope},
           {"gradient mls 1", mls_1_slope},
           {"gradient mls 2", mls_2_slope},
           {"velocity gradient", velocity_gradient},
           {"divergence difference", divergence},
           {"curl difference", curl},
           {"laplacian arithmetic", lap_arithmetic},
           {"laplacian harmonic", lap_harmonic},
           {"laplacian corrected", lap_corrected},
           {"laplacian fatehi-manzari", lap_fatehi},
           {"second derivatives mls 2", mls_2_second},
           {"grad div", grad_div},
           {"mcg", mcg}};
enum { ALL = sizeof all / sizeof *all };
_Static_assert((int)ALL <= (int)TRUNCATIONS, "room for all");

const char *truncation_name(int k) { return k >= 0 && k < ALL ? all[k].name : NULL; }

void truncation_measure(int dim, int across, double h_over_dx, const char *kernel, double jitter,
                        double error[TRUNCATIONS])
{
  field w = make(dim, across, h_over_dx, kernel, jitter);
  for (int k = 0; k < ALL; k++) error[k] = all[k].measure(&w);
  drop(&w);
}
