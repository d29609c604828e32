/* Every operator, on uneven shaken points with and without ends, with every kernel, against the
 * formulas written again: all pairs, index by index, in long double. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "cloud.h"
#include "cpu.h"
#include "oracle.h"

enum { OUT = 9, UNKNOWNS = 10, PROBES = 20, PLACES = 24 };

/* Fields, and the neighbours of one place. */
typedef struct scene {
  cloud c;
  oracle kernel; /* dim, kernel, h */
  double *f, *k, *u[3], *tensor[9];
} scene;

typedef struct neighbor {
  long j;
  real r[3], r2, V, W, F; /* r_ij, W_ij, F_ij */
} neighbor;

typedef struct row {
  const scene *s;
  long i; /* -1: a probe */
  int dim;
  long n;
  neighbor *at; /* itself among them */
} row;

/* ---- the formulas again */

typedef void formula(const row *w, real *out);

static real value(const row *w, const double *f, long k) { return f[w->at[k].j]; }
static real jump(const row *w, const double *f, long k) { return (real)f[w->i] - value(w, f, k); }

/* x of A x = b, by elimination with the largest pivot. */
static void eliminate(int n, real A[UNKNOWNS][UNKNOWNS], real *b)
{
  for (int p = 0; p < n; p++) {
    int best = p;
    for (int r = p; r < n; r++)
      if (fabsl(A[r][p]) > fabsl(A[best][p])) best = r;
    for (int c = 0; c < n; c++) {
      real t = A[p][c];
      A[p][c] = A[best][c], A[best][c] = t;
    }
    real t = b[p];
    b[p] = b[best], b[best] = t;
    for (int r = 0; r < n; r++) {
      if (r == p) continue;
      real ratio = A[r][p] / A[p][p];
      for (int c = p; c < n; c++) A[r][c] -= ratio * A[p][c];
      b[r] -= ratio * b[p];
    }
  }
  for (int p = 0; p < n; p++) b[p] /= A[p][p];
}

static void interpolate(const row *w, real *out)
{
  for (long k = 0; k < w->n; k++) out[0] += w->at[k].V * value(w, w->s->f, k) * w->at[k].W;
}

static void shepard(const row *w, real *out)
{
  real norm = 0;
  for (long k = 0; k < w->n; k++) norm += w->at[k].V * w->at[k].W;
  interpolate(w, out);
  out[0] /= norm;
}

static void cspm(const row *w, real *out)
{
  real A[UNKNOWNS][UNKNOWNS] = {{0}};
  for (long k = 0; k < w->n; k++) {
    const neighbor *j = &w->at[k];
    real f = value(w, w->s->f, k);
    A[0][0] += j->V * j->W, out[0] += j->V * f * j->W;
    for (int a = 0; a < w->dim; a++) {
      A[0][a + 1] -= j->V * j->r[a] * j->W;
      A[a + 1][0] += j->V * j->r[a] * j->F;
      out[a + 1] += j->V * f * j->r[a] * j->F;
      for (int b = 0; b < w->dim; b++) A[a + 1][b + 1] -= j->V * j->r[a] * j->r[b] * j->F;
    }
  }
  eliminate(w->dim + 1, A, out);
}

static void mls(const row *w, int order, real *out)
{
  real A[UNKNOWNS][UNKNOWNS] = {{0}}, p[UNKNOWNS];
  int n = 0;
  for (long k = 0; k < w->n; k++) {
    const neighbor *j = &w->at[k];
    n = 0, p[n++] = 1;
    for (int a = 0; a < w->dim; a++) p[n++] = -j->r[a];
    for (int a = 0; a < w->dim && order == 2; a++)
      for (int b = a; b < w->dim; b++) p[n++] = j->r[a] * j->r[b] / (a == b ? 2 : 1);
    for (int a = 0; a < n; a++) {
      out[a] += j->V * j->W * p[a] * value(w, w->s->f, k);
      for (int b = 0; b < n; b++) A[a][b] += j->V * j->W * p[a] * p[b];
    }
  }
  eliminate(n, A, out);
}
static void mls_1(const row *w, real *out) { mls(w, 1, out); }
static void mls_2(const row *w, real *out)
{
  real all[UNKNOWNS] = {0};
  mls(w, 2, all); /* ten in 3D: dz instead of dy, which is left out */
  for (int a = 0; a < w->dim * (w->dim + 1) / 2; a++) out[a] = all[1 + w->dim + a];
  out[6] = all[0], out[7] = all[1];
  if (w->dim > 1) out[8] = all[w->dim];
}

/* sum_j V_j s_ij grad_i W_ij of one field */
static void gradient(const row *w, const char *form, const double *f, real *out)
{
  const double *rho = w->s->c.density;
  for (long k = 0; k < w->n; k++) {
    const neighbor *j = &w->at[k];
    const real f_i = w->i < 0 ? NAN : f[w->i], f_j = f[j->j], rho_j = rho[j->j];
    const real rho_i = w->i < 0 ? NAN : rho[w->i], m = rho_j * j->V;
    real s = j->V * (f_j - f_i);
    if (!strcmp(form, "plain")) s = j->V * f_j;
    if (!strcmp(form, "density")) s = m * (f_j - f_i) / rho_i;
    if (!strcmp(form, "symmetric")) s = rho_i * m * (f_i / rho_i / rho_i + f_j / rho_j / rho_j);
    if (!strcmp(form, "plus")) s = j->V * (f_i + f_j);
    for (int a = 0; a < w->dim; a++) out[a] += s * j->r[a] * j->F;
  }
  if (strcmp(form, "corrected")) return;
  real M[UNKNOWNS][UNKNOWNS] = {{0}};
  for (long k = 0; k < w->n; k++)
    for (int a = 0; a < w->dim; a++)
      for (int b = 0; b < w->dim; b++)
        M[a][b] -= w->at[k].V * w->at[k].r[a] * w->at[k].r[b] * w->at[k].F;
  eliminate(w->dim, M, out);
}

#define GRADIENT(form) \
  static void gradient_##form(const row *w, real *out) { gradient(w, #form, w->s->f, out); }
GRADIENT(plain)
GRADIENT(difference)
GRADIENT(density)
GRADIENT(symmetric)
GRADIENT(plus)
GRADIENT(corrected)

static void gradient_vector(const row *w, real *out)
{
  for (int a = 0; a < w->dim; a++) gradient(w, "corrected", w->s->u[a], out + a * w->dim);
}

static void divergence(const row *w, real *out)
{
  for (int a = 0; a < w->dim; a++) {
    real g[3] = {0};
    gradient(w, "difference", w->s->u[a], g);
    out[0] += g[a];
  }
}

static void divergence_tensor(const row *w, real *out)
{
  for (int a = 0; a < w->dim; a++)
    for (int b = 0; b < w->dim; b++) {
      real g[3] = {0};
      gradient(w, "symmetric", w->s->tensor[a * w->dim + b], g);
      out[a] += g[b];
    }
}

/* sum_j V_j grad_i W_ij x (u_j - u_i) */
static void curl(const row *w, real *out)
{
  for (long k = 0; k < w->n; k++) {
    const neighbor *j = &w->at[k];
    real u[3] = {0}, r[3] = {0};
    for (int a = 0; a < w->dim; a++) u[a] = -j->V * j->F * jump(w, w->s->u[a], k), r[a] = j->r[a];
    real z = r[0] * u[1] - r[1] * u[0];
    if (w->dim == 2) out[0] += z;
    if (w->dim < 3) continue;
    out[0] += r[1] * u[2] - r[2] * u[1];
    out[1] += r[2] * u[0] - r[0] * u[2];
    out[2] += z;
  }
}

/* spiky's F is softened */
static real soft(const row *w, long k)
{
  const real r2 = w->at[k].r2, h = w->s->kernel.h;
  return w->s->kernel.kernel == ORACLE_SPIKY ? r2 / (r2 + h * h / 100) : 1;
}

static void arithmetic(const row *w, real *out)
{
  for (long k = 0; k < w->n; k++)
    out[0] += w->at[k].V * ((real)w->s->k[w->i] + w->s->k[w->at[k].j]) * jump(w, w->s->f, k) *
              w->at[k].F * soft(w, k);
}

static void harmonic(const row *w, real *out)
{
  for (long k = 0; k < w->n; k++) {
    const real a = w->s->k[w->i], b = w->s->k[w->at[k].j];
    out[0] += w->at[k].V * 4 * a * b / (a + b) * jump(w, w->s->f, k) * w->at[k].F * soft(w, k);
  }
}

static void subtracted(const row *w, real *out)
{
  real g[3] = {0};
  gradient_corrected(w, g);
  for (long k = 0; k < w->n; k++) {
    real bracket = jump(w, w->s->f, k);
    for (int a = 0; a < w->dim; a++) bracket -= w->at[k].r[a] * g[a];
    out[0] += 2 * w->at[k].V * bracket * w->at[k].F * soft(w, k);
  }
}

/* The 4th-rank sums of Fatehi & Manzari (2011), without any symmetry made use of:
 * four^cdef = sum_j V_j r e^c e^d e^e d^f W, T^cda = sum_j V_j r^c r^d (M^-1 grad W)^a,
 * E^aef = sum_j V_j e^a e^e d^f W. */
typedef struct tensors {
  real four[3][3][3][3], T[3][3][3], E[3][3][3];
} tensors;

static void sum_tensors(const row *w, tensors *t)
{
  const int dim = w->dim;
  memset(t, 0, sizeof *t);
  for (int c = 0; c < dim; c++)
    for (int d = 0; d < dim; d++) {
      real M[UNKNOWNS][UNKNOWNS] = {{0}}, *T = t->T[c][d];
      for (long k = 0; k < w->n; k++) {
        const neighbor *j = &w->at[k];
        for (int a = 0; a < dim; a++) {
          T[a] += j->V * j->r[c] * j->r[d] * j->r[a] * j->F;
          for (int b = 0; b < dim; b++) M[a][b] -= j->V * j->r[a] * j->r[b] * j->F;
        }
        if (j->r2 == 0) continue;
        const real r = sqrtl(j->r2);
        for (int e = 0; e < dim; e++)
          for (int f = 0; f < dim; f++) {
            const real slope = j->V * j->r[f] * j->F;
            t->four[c][d][e][f] += r * j->r[c] / r * j->r[d] / r * j->r[e] / r * slope;
            t->E[c][e][f] += d == 0 ? j->r[c] / r * j->r[e] / r * slope : 0;
          }
      }
      eliminate(dim, M, T);
    }
}

static void fatehi(const row *w, real *out)
{
  static const int pair[4][6][2] = {{{0}},
                                    {{0, 0}},
                                    {{0, 0}, {1, 1}, {0, 1}},
                                    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
  const int dim = w->dim, pairs = dim * (dim + 1) / 2;
  tensors t;
  real A[UNKNOWNS][UNKNOWNS], B[UNKNOWNS], full[3][3], g[3] = {0};
  sum_tensors(w, &t);
  for (int p = 0; p < pairs; p++)
    for (int q = 0; q < pairs; q++) {
      const int c = pair[dim][p][0], d = pair[dim][p][1];
      const int e = pair[dim][q][0], f = pair[dim][q][1];
      A[p][q] = t.four[c][d][e][f] + (e == f ? 0 : t.four[c][d][f][e]);
      for (int a = 0; a < dim; a++)
        A[p][q] += t.T[c][d][a] * (t.E[a][e][f] + (e == f ? 0 : t.E[a][f][e]));
      B[p] = c == d ? -1 : 0;
    }
  eliminate(pairs, A, B);
  for (int p = 0; p < pairs; p++)
    full[pair[dim][p][0]][pair[dim][p][1]] = full[pair[dim][p][1]][pair[dim][p][0]] = B[p];
  gradient_corrected(w, g);
  for (long k = 0; k < w->n; k++) {
    const neighbor *j = &w->at[k];
    if (j->r2 == 0) continue;
    const real r = sqrtl(j->r2);
    real bracket = jump(w, w->s->f, k) / r, weight = 0;
    for (int a = 0; a < dim; a++) {
      bracket -= j->r[a] / r * g[a];
      for (int b = 0; b < dim; b++) weight += full[a][b] * j->r[a] / r * j->r[b] * j->F;
    }
    out[0] += 2 * j->V * bracket * weight;
  }
}

/* sum_j V_j F (along (e.u) e + across u) */
static void central(const row *w, real along, real across, real *out)
{
  for (long k = 0; k < w->n; k++) {
    const neighbor *j = &w->at[k];
    if (j->r2 == 0) continue;
    const real r = sqrtl(j->r2);
    real eu = 0;
    for (int a = 0; a < w->dim; a++) eu += j->r[a] / r * jump(w, w->s->u[a], k);
    for (int a = 0; a < w->dim; a++)
      out[a] += j->V * j->F * (along * eu * j->r[a] / r + across * jump(w, w->s->u[a], k));
  }
}
static void grad_div(const row *w, real *out) { central(w, w->dim + 2, -1, out); }
static void mcg(const row *w, real *out) { central(w, 2 * (w->dim + 2), 0, out); }

/* ---- the library's */

typedef int call(sph_operator *op, const scene *s, double *const out[], sph_error *error);

static const double *const *u_of(const scene *s) { return (const double *const *)s->u; }

static int call_interpolate(sph_operator *op, const scene *s, double *const o[], sph_error *e)
{
  return sph_operator_interpolate(op, s->f, o[0], e);
}
static int call_shepard(sph_operator *op, const scene *s, double *const o[], sph_error *e)
{
  return sph_operator_shepard(op, s->f, o[0], e);
}
static int call_cspm(sph_operator *op, const scene *s, double *const o[], sph_error *e)
{
  return sph_operator_cspm(op, s->f, o[0], o + 1, e);
}
static int call_mls_1(sph_operator *op, const scene *s, double *const o[], sph_error *e)
{
  return sph_operator_mls(op, 1, s->f, o[0], o + 1, NULL, e);
}
static int call_mls_2(sph_operator *op, const scene *s, double *const o[], sph_error *e)
{
  double *const g[3][3] = {{o[7]}, {o[7], o[8]}, {o[7], o[5], o[8]}}; /* o[5] is written later */
  int status = sph_operator_mls(op, 2, s->f, o[6], g[s->c.dim - 1], NULL, e);
  return status ? status : sph_operator_mls(op, 2, s->f, NULL, NULL, o, e);
}
#define CALL_GRADIENT(form)                                                            \
  static int call_gradient_##form(sph_operator *op, const scene *s, double *const o[], \
                                  sph_error *e)                                        \
  {                                                                                    \
    return sph_operator_gradient(op, #form, s->f, o, e);                               \
  }
CALL_GRADIENT(plain)
CALL_GRADIENT(difference)
CALL_GRADIENT(density)
CALL_GRADIENT(symmetric)
CALL_GRADIENT(plus)
CALL_GRADIENT(corrected)
static int call_gradient_vector(sph_operator *op, const scene *s, double *const o[], sph_error *e)
{
  return sph_operator_gradient_vector(op, "corrected", u_of(s), o, e);
}
static int call_divergence(sph_operator *op, const scene *s, double *const o[], sph_error *e)
{
  return sph_operator_divergence(op, "difference", u_of(s), o[0], e);
}
static int call_tensor(sph_operator *op, const scene *s, double *const o[], sph_error *e)
{
  return sph_operator_divergence_tensor(op, "symmetric", (const double *const *)s->tensor, o, e);
}
static int call_curl(sph_operator *op, const scene *s, double *const o[], sph_error *e)
{
  return sph_operator_curl(op, "difference", u_of(s), o, e);
}
#define CALL_LAPLACIAN(c_name, form, k)                                                \
  static int c_name(sph_operator *op, const scene *s, double *const o[], sph_error *e) \
  {                                                                                    \
    return sph_operator_laplacian(op, form, k, s->f, o[0], e);                         \
  }
CALL_LAPLACIAN(call_arithmetic, "arithmetic", s->k)
CALL_LAPLACIAN(call_harmonic, "harmonic", s->k)
CALL_LAPLACIAN(call_subtracted, "corrected", NULL)
CALL_LAPLACIAN(call_fatehi, "fatehi-manzari", NULL)
static int call_grad_div(sph_operator *op, const scene *s, double *const o[], sph_error *e)
{
  return sph_operator_grad_div(op, u_of(s), o, e);
}
static int call_mcg(sph_operator *op, const scene *s, double *const o[], sph_error *e)
{
  return sph_operator_mcg(op, u_of(s), o, e);
}

typedef struct known {
  const char *name;
  formula *formula;
  call *call;
  int probes;       /* also away from the points */
  int least_dim;    /* with fewer dimensions there is none */
  double tolerance; /* of the largest value, which rounding of sums and solves allows */
} known;

static const known all[] = {
    {"interpolate", interpolate, call_interpolate, 1, 1, 1e-14},
    {"shepard", shepard, call_shepard, 1, 1, 1e-14},
    {"cspm", cspm, call_cspm, 1, 1, 3e-13},
    {"mls 1", mls_1, call_mls_1, 1, 1, 3e-13},
    {"mls 2", mls_2, call_mls_2, 1, 1, 1e-12},
    {"plain", gradient_plain, call_gradient_plain, 1, 1, 3e-14},
    {"difference", gradient_difference, call_gradient_difference, 0, 1, 3e-14},
    {"density", gradient_density, call_gradient_density, 0, 1, 3e-14},
    {"symmetric", gradient_symmetric, call_gradient_symmetric, 0, 1, 3e-14},
    {"plus", gradient_plus, call_gradient_plus, 0, 1, 3e-14},
    {"corrected", gradient_corrected, call_gradient_corrected, 0, 1, 3e-14},
    {"gradient of a vector", gradient_vector, call_gradient_vector, 0, 1, 3e-14},
    {"divergence", divergence, call_divergence, 0, 1, 3e-14},
    {"divergence of a tensor", divergence_tensor, call_tensor, 0, 1, 3e-14},
    {"curl", curl, call_curl, 0, 2, 3e-14},
    {"arithmetic", arithmetic, call_arithmetic, 0, 1, 3e-14},
    {"harmonic", harmonic, call_harmonic, 0, 1, 3e-14},
    {"subtracted", subtracted, call_subtracted, 0, 1, 3e-14},
    {"fatehi-manzari", fatehi, call_fatehi, 0, 1, 1e-12},
    {"grad div", grad_div, call_grad_div, 0, 1, 3e-14},
    {"mcg", mcg, call_mcg, 0, 1, 3e-14},
};
enum { ALL = sizeof all / sizeof *all };

/* ---- scenes */

static scene scene_make(int dim, int periodic, int kernel)
{
  static const int across[] = {40, 14, 8};
  const sph_kernel *k = sph_kernel_get(kernel);
  scene s = {.c = cloud_make(dim, across[dim - 1], 0.2, periodic, 1)};
  /* wider than usual: all fits must be possible, in corners, too */
  s.kernel = (oracle){.dim = dim, .kernel = (enum oracle_kernel)kernel};
  s.kernel.h = (real)(dim == 3 ? 3.9 : 5.8) / sph_kernel_support(k) * s.c.dx;
  if (dim == 3 && !periodic) s.kernel.h *= 1.2L;
  s.f = cloud_array(s.c.n), s.k = cloud_array(s.c.n);
  for (int d = 0; d < 3; d++) s.u[d] = cloud_array(s.c.n);
  for (int d = 0; d < 9; d++) s.tensor[d] = cloud_array(s.c.n);
  for (long i = 0; i < s.c.n; i++) {
    s.f[i] = 2 + cloud_noise(&s.c), s.k[i] = 1.5 + cloud_noise(&s.c);
    for (int d = 0; d < 3; d++) s.u[d][i] = cloud_noise(&s.c);
    for (int d = 0; d < 9; d++) s.tensor[d][i] = cloud_noise(&s.c);
  }
  return s;
}

static void scene_free(scene *s)
{
  cloud_free(&s->c);
  free(s->f), free(s->k);
  for (int d = 0; d < 3; d++) free(s->u[d]);
  for (int d = 0; d < 9; d++) free(s->tensor[d]);
}

/* All points around a place, by all pairs. */
static void find_row(const scene *s, const double *x, row *w)
{
  const sph_kernel *kernel = sph_kernel_get((int)s->kernel.kernel);
  const real reach = (real)sph_kernel_support(kernel) * s->kernel.h;
  w->n = 0;
  for (long j = 0; j < s->c.n; j++) {
    neighbor *at = &w->at[w->n];
    *at = (neighbor){.j = j, .V = s->c.volume[j]};
    for (int d = 0; d < s->c.dim; d++) {
      at->r[d] = (real)x[d] - s->c.x[d][j];
      if (s->c.periodic) at->r[d] -= roundl(at->r[d]);
      at->r2 += at->r[d] * at->r[d];
    }
    const real r = sqrtl(at->r2);
    at->W = oracle_w(&s->kernel, r), at->F = oracle_f(&s->kernel, r);
    w->n += r < reach;
  }
}

/* Largest difference over largest value, of places x[dim][n]. */
static double compare(const scene *s, const known *k, sph_operator *op, int probing, long n,
                      double *const x[])
{
  double *out[OUT];
  sph_error error = {0};
  double worst = 0, largest = 0;
  row w = {.s = s, .dim = s->c.dim, .at = calloc((size_t)s->c.n, sizeof *w.at)};
  for (int o = 0; o < OUT; o++) out[o] = cloud_array(n);
  if (k->call(op, s, out, &error)) fail_msg("%s: %s", k->name, error.text);
  for (long i = 0; i < n; i += n / PLACES + 1) { /* corners and middles, of any kind */
    real right[UNKNOWNS] = {0};
    const double at[] = {x[0][i], x[1][i], x[2][i]};
    find_row(s, at, &w);
    w.i = probing ? -1 : i;
    k->formula(&w, right);
    for (int o = 0; o < OUT; o++) {
      const double off = fabs((double)(out[o][i] - right[o]));
      worst = off <= worst ? worst : off; /* NaN stays */
      largest = fmax(largest, fabs((double)right[o]));
    }
  }
  for (int o = 0; o < OUT; o++) free(out[o]);
  free(w.at);
  return worst / largest;
}

static void all_against_formulas(int probing)
{
  for (int dim = 1; dim <= 3; dim++)
    for (int kernel = 0; sph_kernel_get(kernel); kernel++)
      for (int periodic = 0; periodic < 2; periodic++) {
        scene s = scene_make(dim, periodic, kernel);
        sph_operator *op =
            cloud_operator(&s.c,
                           (sph_operator_def){.h = (double)s.kernel.h,
                                              .kernel = sph_kernel_name(sph_kernel_get(kernel))});
        double *at[3];
        for (int d = 0; d < 3; d++) at[d] = cloud_array(PROBES);
        for (long i = 0; i < PROBES; i++)
          for (int d = 0; d < dim; d++) at[d][i] = 0.5 + 0.5 * cloud_noise(&s.c);
        if (probing)
          assert_int_equal(sph_operator_set_probes(op, PROBES, (const double *const *)at, NULL), 0);
        for (int k = 0; k < ALL; k++) {
          if (all[k].least_dim > dim || (probing && !all[k].probes)) continue;
          double off =
              compare(&s, &all[k], op, probing, probing ? PROBES : s.c.n, probing ? at : s.c.x);
          if (!(off <= all[k].tolerance))
            fail_msg("%s, %dD, %s, periodic %d: off by %g", all[k].name, dim,
                     sph_kernel_name(sph_kernel_get(kernel)), periodic, off);
        }
        for (int d = 0; d < 3; d++) free(at[d]);
        sph_operator_free(op);
        scene_free(&s);
      }
}

static void at_points(void **state)
{
  (void)state;
  all_against_formulas(0);
}

static void at_probes(void **state)
{
  (void)state;
  all_against_formulas(1);
}

/* ---- the same bits for any number of threads, the same to rounding in any other way */

static void evaluate(const scene *s, const known *k, sph_operator_def def, double *const out[])
{
  sph_error error = {0};
  def.h = (double)s->kernel.h, def.kernel = sph_kernel_name(sph_kernel_get((int)s->kernel.kernel));
  sph_operator *op = cloud_operator(&s->c, def);
  if (k->call(op, s, out, &error)) fail_msg("%s: %s", k->name, error.text);
  sph_operator_free(op);
}

static void same_bits(void **state)
{
  (void)state;
  scene s = scene_make(2, 1, 0);
  double *one[OUT], *more[OUT];
  for (int o = 0; o < OUT; o++) one[o] = cloud_array(s.c.n), more[o] = cloud_array(s.c.n);
  for (int k = 0; k < ALL; k++)
    for (int threads = 2; threads <= 7; threads += 5) {
      evaluate(&s, &all[k], (sph_operator_def){.threads = 1}, one);
      evaluate(&s, &all[k], (sph_operator_def){.threads = threads}, more);
      for (int o = 0; o < OUT; o++)
        assert_memory_equal(one[o], more[o], (size_t)s.c.n * sizeof(double));
    }
  for (int o = 0; o < OUT; o++) free(one[o]), free(more[o]);
  scene_free(&s);
}

static void same_search(void **state)
{
  (void)state;
  scene s = scene_make(3, 1, 0);
  double *one[OUT], *other[OUT];
  for (int o = 0; o < OUT; o++) one[o] = cloud_array(s.c.n), other[o] = cloud_array(s.c.n);
  for (int k = 0; k < ALL; k++) {
    double largest = 0;
    evaluate(&s, &all[k], (sph_operator_def){0}, one);
    for (int isa = 0; isa <= SPH_ISA_COUNT; isa++) {
      const char *name = isa < SPH_ISA_COUNT ? sph_cpu_isa_name(isa) : NULL;
      if (name && sph_cpu_isa(name, NULL) < 0) continue;
      if (name) setenv("SPHODE_ISA", name, 1);
      evaluate(&s, &all[k], (sph_operator_def){.search = name ? NULL : "brute-force"}, other);
      unsetenv("SPHODE_ISA");
      for (int o = 0; o < OUT; o++)
        for (long i = 0; i < s.c.n; i++) largest = fmax(largest, fabs(one[o][i]));
      for (int o = 0; o < OUT; o++)
        for (long i = 0; i < s.c.n; i++)
          if (!(fabs(one[o][i] - other[o][i]) <= 2 * all[k].tolerance * largest))
            fail_msg("%s: %.17g and %.17g with %s", all[k].name, one[o][i], other[o][i],
                     name ? name : "brute force");
    }
  }
  for (int o = 0; o < OUT; o++) free(one[o]), free(other[o]);
  scene_free(&s);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(at_points), cmocka_unit_test(at_probes),
                                     cmocka_unit_test(same_bits), cmocka_unit_test(same_search)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
