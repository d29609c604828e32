/* Slow and plain on purpose: one function per equation, all pairs, no lists, no tables. */
#include "oracle.h"

#include <math.h>

static const real pi = 3.14159265358979323846264338327950288L;

/* ---- kernels: W = sigma/h^d w(q), F = W'/r = sigma/h^(d+2) f(q), f = w'/q, q < kappa ---- */

static real kappa(const oracle *o)
{
  return o->kernel == ORACLE_QUINTIC || o->kernel == ORACLE_GAUSSIAN || o->kernel == ORACLE_SHIFTED
             ? 3
             : 2;
}

/* 1/sigma of the Gaussians is their integral up to 3. */
static real sigma(const oracle *o)
{
  real root = sqrtl(pi) * erfl(3), e = expl(-9);
  const real table[][3] = {
      [ORACLE_WENDLAND_C2] = {5 / 8.0L, 7 / (4 * pi), 21 / (16 * pi)},
      [ORACLE_WENDLAND_C4] = {3 / 4.0L, 9 / (4 * pi), 495 / (256 * pi)},
      [ORACLE_WENDLAND_C6] = {55 / 64.0L, 39 / (14 * pi), 1365 / (512 * pi)},
      [ORACLE_CUBIC] = {2 / 3.0L, 10 / (7 * pi), 1 / pi},
      [ORACLE_QUINTIC] = {1 / 120.0L, 7 / (478 * pi), 1 / (120 * pi)},
      [ORACLE_GAUSSIAN] = {1 / root, 1 / (pi * (1 - e)), 1 / (pi * (root - 6 * e))},
      [ORACLE_SHIFTED] = {1 / (root - 6 * e), 1 / (pi * (1 - 10 * e)), 1 / (pi * (root - 42 * e))},
      [ORACLE_SPIKY] = {1 / 8.0L, 5 / (16 * pi), 15 / (64 * pi)},
  };
  return table[o->kernel][o->dim - 1];
}

static real shape(const oracle *o, real q)
{
  real t = 1 - q / 2, a = 3 - q, b = q < 2 ? 2 - q : 0, c = q < 1 ? 1 - q : 0;
  int line = o->dim == 1;
  switch (o->kernel) {
  case ORACLE_WENDLAND_C2: return line ? powl(t, 3) * (1 + 3 * q / 2) : powl(t, 4) * (1 + 2 * q);
  case ORACLE_WENDLAND_C4:
    return line ? powl(t, 5) * (1 + 5 * q / 2 + 2 * q * q)
                : powl(t, 6) * (1 + 3 * q + 35 * q * q / 12);
  case ORACLE_WENDLAND_C6:
    return line ? powl(t, 7) * (1 + 7 * q / 2 + 19 * q * q / 4 + 21 * q * q * q / 8)
                : powl(t, 8) * (1 + 4 * q + 25 * q * q / 4 + 4 * q * q * q);
  case ORACLE_CUBIC: return q < 1 ? 1 - 3 * q * q / 2 + 3 * q * q * q / 4 : powl(2 - q, 3) / 4;
  case ORACLE_QUINTIC: return powl(a, 5) - 6 * powl(b, 5) + 15 * powl(c, 5);
  case ORACLE_GAUSSIAN: return expl(-q * q);
  case ORACLE_SHIFTED: return expl(-q * q) - expl(-9);
  case ORACLE_SPIKY: return powl(2 - q, 3);
  }
  return 0;
}

static real shape_f(const oracle *o, real q)
{
  real t = 1 - q / 2, a = 3 - q, b = q < 2 ? 2 - q : 0;
  int line = o->dim == 1;
  switch (o->kernel) {
  case ORACLE_WENDLAND_C2: return line ? -3 * t * t : -5 * t * t * t;
  case ORACLE_WENDLAND_C4:
    return line ? -7 * (1 + 2 * q) * powl(t, 4) / 2 : -14 * (1 + 5 * q / 2) * powl(t, 5) / 3;
  case ORACLE_WENDLAND_C6:
    return line ? -3 * (12 + 36 * q + 35 * q * q) * powl(t, 6) / 8
                : -11 * (2 + 7 * q + 8 * q * q) * powl(t, 7) / 4;
  case ORACLE_CUBIC: return q < 1 ? -3 + 9 * q / 4 : -3 * (2 - q) * (2 - q) / (4 * q);
  case ORACLE_QUINTIC:
    return q < 1 ? -120 + 120 * q * q - 50 * q * q * q : (-5 * powl(a, 4) + 30 * powl(b, 4)) / q;
  case ORACLE_GAUSSIAN:
  case ORACLE_SHIFTED: return -2 * expl(-q * q);
  case ORACLE_SPIKY: return q > 0 ? -3 * (2 - q) * (2 - q) / q : 0; /* grad W = 0 there */
  }
  return 0;
}

real oracle_w(const oracle *o, real r)
{
  real q = r / o->h;
  return q < kappa(o) ? sigma(o) / powl(o->h, o->dim) * shape(o, q) : 0;
}

real oracle_f(const oracle *o, real r)
{
  real q = r / o->h;
  return q < kappa(o) ? sigma(o) / powl(o->h, o->dim + 2) * shape_f(o, q) : 0;
}

/* ---- a pair: r_ij = x_i - x_j of the nearest image, grad W = r_ij F ---- */

typedef struct pair {
  real d[3], r;      /* r_ij, |r_ij| */
  real f, grad_w[3]; /* F, grad_i W */
  real grad;         /* |grad W| */
} pair;

static real dot(const real a[3], const real b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static real norm(const real a[3]) { return sqrtl(dot(a, a)); }
static void difference(const real a[3], const real b[3], real out[3])
{
  for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

/* 0: too far. */
static int near(const oracle *o, long i, long j, pair *ij)
{
  difference(o->particle[i].x, o->particle[j].x, ij->d);
  for (int k = 0; k < o->dim; k++)
    if (o->periodic[k]) ij->d[k] -= o->length[k] * roundl(ij->d[k] / o->length[k]);
  ij->r = norm(ij->d);
  if (ij->r >= kappa(o) * o->h) return 0;
  ij->f = oracle_f(o, ij->r);
  for (int k = 0; k < 3; k++) ij->grad_w[k] = ij->d[k] * ij->f;
  ij->grad = ij->r * fabsl(ij->f);
  return 1;
}

static int is_dust(const oracle *o, long i) { return o->group[o->particle[i].group].dust; }
static int is_wall(const oracle *o, long i) { return o->group[o->particle[i].group].wall; }

/* Density diffuses where rho0 and c0 are the same: within a fluid, and at walls of its equation of
 * state. */
static int same_fluid(const oracle *o, long i, long j)
{
  const oracle_eos *a = &o->group[o->particle[i].group].eos;
  const oracle_eos *b = &o->group[o->particle[j].group].eos;
  return !is_dust(o, i) && !is_dust(o, j) && a->rho0 == b->rho0 && a->c0 == b->c0;
}

/* Fluids and walls are one, each dust is another. */
static int same_species(const oracle *o, long i, long j)
{
  return o->particle[i].group == o->particle[j].group || (!is_dust(o, i) && !is_dust(o, j));
}
static const oracle_eos *eos_of(const oracle *o, long i)
{
  return &o->group[o->particle[i].group].eos;
}

/* ---- equations of state ---- */

static void pressure_of(const oracle_eos *eos, oracle_particle *i)
{
  real b = eos->rho0 * eos->c0 * eos->c0 / eos->gamma, s = i->rho / eos->rho0;
  switch (eos->kind) {
  case ORACLE_TAIT:
    i->p = b * (powl(s, eos->gamma) - 1) + eos->p_background;
    i->c = eos->c0 * powl(s, (eos->gamma - 1) / 2);
    i->p_size = b * (powl(s, eos->gamma) + 1) + fabsl(eos->p_background);
    break;
  case ORACLE_LINEAR:
    i->p = eos->c0 * eos->c0 * (i->rho - eos->rho0) + eos->p_background;
    i->c = eos->c0;
    i->p_size = eos->c0 * eos->c0 * (i->rho + eos->rho0) + fabsl(eos->p_background);
    break;
  case ORACLE_IDEAL_GAS:
    i->p = (eos->gamma - 1) * i->rho * i->u;
    i->c = sqrtl(eos->gamma * (eos->gamma - 1) * i->u);
    i->p_size = i->p;
    break;
  }
}

static real density_of(const oracle_eos *eos, real p, real u)
{
  real b = eos->rho0 * eos->c0 * eos->c0 / eos->gamma;
  switch (eos->kind) {
  case ORACLE_TAIT: return eos->rho0 * powl(1 + (p - eos->p_background) / b, 1 / eos->gamma);
  case ORACLE_LINEAR: return eos->rho0 + (p - eos->p_background) / (eos->c0 * eos->c0);
  case ORACLE_IDEAL_GAS: return p / ((eos->gamma - 1) * u);
  }
  return 0;
}

/* rho_i = sum m_j W_ij, itself included; a wall counts with its density at rest. */
static void densities(oracle *o)
{
  for (long i = 0; o->summed && i < o->n; i++) {
    oracle_particle *it = &o->particle[i];
    pair ij;
    if (is_wall(o, i)) continue;
    it->rho = 0;
    for (long j = 0; j < o->n; j++) {
      const oracle_particle *other = &o->particle[j];
      if (!near(o, i, j, &ij) || !same_species(o, i, j)) continue;
      it->rho += other->m * oracle_w(o, ij.r);
    }
  }
}

static void materials(oracle *o)
{
  for (long i = 0; i < o->n; i++) {
    oracle_particle *it = &o->particle[i];
    if (is_wall(o, i)) continue;
    if (!is_dust(o, i)) pressure_of(eos_of(o, i), it);
    it->condition = 1;
    if (o->summed) it->condition = 4, it->p_size *= 4 * eos_of(o, i)->gamma;
    if (eos_of(o, i)->c_v > 0) it->T = it->u / eos_of(o, i)->c_v;
    it->T_size = fabsl(it->T);
    it->phi = powl(it->rho, o->exponent);
    for (int k = 0; k < 3; k++) it->v_viscous[k] = it->v[k];
  }
}

/* ---- walls (Adami, Hu & Adams 2012):
 *   p_w = [sum p_f W + (g - a_w) . sum rho_f r_wf W] / sum W,   rho_w = rho(p_w),
 *   m_w = rho_w V_w, V_w that of its place; v_w = 2 v - <v_f> for viscous terms that see it;
 *   in a gas u_w = <u_f>, and rho_w = rho0 where p_w or u_w is not positive ---- */

static void wall(oracle *o, long w)
{
  oracle_particle *it = &o->particle[w];
  const oracle_group *group = &o->group[it->group];
  real down[3], sum_w = 0, sum_p = 0, sum_u = 0, sum_T = 0, size = 0, sum_v[3] = {0};
  pair wf;
  difference(o->g, group->acceleration, down);
  for (long f = 0; f < o->n; f++) {
    const oracle_particle *fluid = &o->particle[f];
    if (is_wall(o, f) || is_dust(o, f) || !near(o, w, f, &wf)) continue;
    real weight = oracle_w(o, wf.r);
    sum_w += weight;
    sum_p += weight * (fluid->p + fluid->rho * dot(down, wf.d));
    sum_u += weight * fluid->u;
    sum_T += weight * fluid->T;
    real edge = 1 + wf.r * wf.grad / weight; /* W vanishes there, and r is rounded */
    size += weight * edge * (fluid->p_size + fluid->rho * norm(down) * wf.r);
    for (int k = 0; k < 3; k++) sum_v[k] += weight * fluid->v[k];
  }
  it->p = sum_w > 0 ? sum_p / sum_w : 0;
  it->p_size = sum_w > 0 ? size / sum_w : 0;
  if (!group->tension && it->p < 0) it->p = 0;
  it->u = sum_w > 0 ? sum_u / sum_w : 0;
  it->T = sum_w > 0 ? 2 * group->temperature - sum_T / sum_w : 0;
  it->T_size = sum_w > 0 ? 2 * group->temperature + 4 * sum_T / sum_w : 0;
  it->rho = group->rho0;
  it->condition = group->eos.kind == ORACLE_IDEAL_GAS && it->p > 0 ? 1 + it->p_size / it->p : 1;
  if (group->eos.kind != ORACLE_IDEAL_GAS || (it->p > 0 && it->u > 0))
    it->rho = density_of(&group->eos, it->p, it->u);
  if (it->volume == 0) it->volume = it->m / group->rho0; /* its place on the lattice */
  it->m = it->rho * it->volume;
  it->phi = powl(it->rho, o->exponent);
  real p = it->p, p_size = it->p_size;
  pressure_of(&group->eos, it); /* for c */
  it->p = p, it->p_size = p_size;
  for (int k = 0; k < 3; k++) {
    it->v[k] = group->velocity[k];
    it->v_viscous[k] = 2 * it->v[k] - (sum_w > 0 ? sum_v[k] / sum_w : 0);
  }
}

/* ---- gradients:  <grad rho>^L_i = M^-1 sum V_j (rho_j - rho_i) grad W,
 *   M^ab = - sum V_j r^a r^b F;   0 where the smallest eigenvalue of M is below 0.4 ---- */

/* Eigenvalues of a symmetric a[3][3] to a's diagonal, vectors to the columns of q (Jacobi
 * rotations). */
static void eigen(real a[3][3], real q[3][3])
{
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) q[r][c] = r == c;
  for (int sweep = 0; sweep < 60; sweep++) {
    int r = sweep % 3 == 2, c = sweep % 3 == 0 ? 1 : 2; /* (0,1), (0,2), (1,2) */
    if (a[r][c] == 0) continue;
    real theta = atan2l(2 * a[r][c], a[c][c] - a[r][r]) / 2, cs = cosl(theta), sn = sinl(theta);
    for (int k = 0; k < 3; k++) {
      real x = a[k][r], y = a[k][c];
      a[k][r] = cs * x - sn * y, a[k][c] = sn * x + cs * y;
    }
    for (int k = 0; k < 3; k++) {
      real x = a[r][k], y = a[c][k];
      a[r][k] = cs * x - sn * y, a[c][k] = sn * x + cs * y;
      x = q[k][r], y = q[k][c];
      q[k][r] = cs * x - sn * y, q[k][c] = sn * x + cs * y;
    }
  }
}

static void gradient(oracle *o, long i)
{
  oracle_particle *it = &o->particle[i];
  real m[3][3] = {{0}}, q[3][3], b[3] = {0}, size = 0, smallest = INFINITY;
  pair ij;
  for (long j = 0; j < o->n; j++) {
    const oracle_particle *other = &o->particle[j];
    if (j == i || !near(o, i, j, &ij) || !same_fluid(o, i, j)) continue;
    real volume = other->m / other->rho;
    for (int r = 0; r < 3; r++) {
      b[r] += volume * (other->rho - it->rho) * ij.grad_w[r];
      for (int c = 0; c < 3; c++) m[r][c] -= volume * ij.d[r] * ij.d[c] * ij.f;
    }
    size += volume * (other->rho + it->rho) * ij.grad;
  }
  eigen(m, q);
  for (int e = 0; e < 3; e++)
    if (e < o->dim && m[e][e] < smallest) smallest = m[e][e];
  for (int k = 0; k < 3; k++) it->gradient[k] = 0;
  it->gradient_size = 0;
  if (smallest < 0.4L) return;
  it->gradient_size = size / smallest;
  for (int e = 0; e < o->dim; e++) {
    real along = (q[0][e] * b[0] + q[1][e] * b[1] + q[2][e] * b[2]) / m[e][e];
    for (int k = 0; k < 3; k++) it->gradient[k] += along * q[k][e];
  }
}

/* ---- B = M^-1 of terms whose gradients are corrected, M as above but over all of the species;
 *   1 where the smallest eigenvalue of M is below 0.2 ---- */

static int corrected(const oracle *o)
{
  return o->continuity_corrected || o->pressure_corrected || o->laminar_corrected;
}

static void inverse(oracle *o, long i)
{
  oracle_particle *it = &o->particle[i];
  real m[3][3] = {{0}}, q[3][3], size = 0, smallest = INFINITY;
  pair ij;
  for (long j = 0; j < o->n; j++) {
    const oracle_particle *other = &o->particle[j];
    if (j == i || !near(o, i, j, &ij) || !same_species(o, i, j)) continue;
    real volume = other->m / other->rho;
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++) m[r][c] -= volume * ij.d[r] * ij.d[c] * ij.f;
    size += volume * ij.r * ij.grad * other->condition;
  }
  eigen(m, q);
  for (int e = 0; e < o->dim; e++)
    if (m[e][e] < smallest) smallest = m[e][e];
  it->B_size = 1;
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) it->B[r][c] = r == c;
  if (smallest < 0.2L) return;
  it->B_size = 1 / smallest + size / (smallest * smallest);
  for (int r = 0; r < o->dim; r++)
    for (int c = 0; c < o->dim; c++) {
      it->B[r][c] = 0;
      for (int e = 0; e < o->dim; e++) it->B[r][c] += q[r][e] * q[c][e] / m[e][e];
    }
}

static void times(const oracle_particle *i, const real a[3], real out[3])
{
  for (int r = 0; r < 3; r++) out[r] = i->B[r][0] * a[0] + i->B[r][1] * a[1] + i->B[r][2] * a[2];
}

/* ---- pair terms: what j adds to i ---- */

/* C1:  drho = sum m_j v_ij.grad W,          a = - sum m_j (p_i/rho_i^2 + p_j/rho_j^2) grad W,
 *      du = p_i/rho_i^2 sum m_j v_ij.grad W
 * C2:  drho = rho_i sum V_j v_ij.grad W,    a = - sum m_j (p_i + p_j)/(rho_i rho_j) grad W,
 *      du = p_i/rho_i sum V_j v_ij.grad W
 * phi: drho = phi_i sum m_j/phi_j v_ij.grad W,
 *      a = - sum m_j (p_i/rho_i^2 phi_i/phi_j + p_j/rho_j^2 phi_j/phi_i) grad W,
 *      du = p_i/rho_i^2 phi_i sum m_j/phi_j v_ij.grad W
 * Corrected: drho and du with B_i grad W; mean: p_i times B_i grad W and p_j times B_j grad W;
 * one-sided, of no row: a = - 1/rho_i sum V_j (p_j - p_i) B_i grad W.  A wall has B of i. */
static real density_factor(enum oracle_row row, const oracle_particle *i, const oracle_particle *j)
{
  if (row == ORACLE_C1) return j->m;
  return row == ORACLE_C2 ? i->rho * j->m / j->rho : i->phi * j->m / j->phi;
}

/* What multiplies p of i (of j: with i and j exchanged). */
static real pressure_factor(enum oracle_row row, const oracle_particle *i, const oracle_particle *j)
{
  if (row == ORACLE_C1) return 1 / (i->rho * i->rho);
  return row == ORACLE_C2 ? 1 / (i->rho * j->rho) : i->phi / (i->rho * i->rho * j->phi);
}

static void corrected_pressure(const oracle *o, int j_is_wall, oracle_particle *i,
                               const oracle_particle *j, const pair *ij)
{
  real of_i = i->p * pressure_factor(o->pressure, i, j), size, grad_i[3], grad_j[3];
  real of_j = j->p * pressure_factor(o->pressure, j, i);
  times(i, ij->grad_w, grad_i);
  times(j_is_wall ? i : j, ij->grad_w, grad_j);
  size = i->p_size * pressure_factor(o->pressure, i, j) * i->B_size +
         j->p_size * pressure_factor(o->pressure, j, i) * (j_is_wall ? i : j)->B_size;
  if (o->pressure_corrected == ORACLE_ONE_SIDED) {
    of_i = (j->p - i->p) / (j->rho * i->rho), of_j = 0;
    size = (j->p_size + i->p_size) / (j->rho * i->rho) * i->B_size;
  }
  for (int k = 0; k < 3; k++) i->a[k] -= j->m * (of_i * grad_i[k] + of_j * grad_j[k]);
  i->a_size += j->m * size * ij->grad * i->condition * j->condition;
}

static void compression(const oracle *o, int j_is_wall, oracle_particle *i,
                        const oracle_particle *j, const pair *ij)
{
  const int dust = o->group[i->group].dust;
  real v[3];
  difference(i->v, j->v, v);
  real rate = dot(v, ij->grad_w), condition = i->condition * j->condition;
  real size = (norm(i->v) + norm(j->v)) * ij->grad * condition;
  if (o->continuity_corrected && !dust) {
    real grad[3];
    times(i, ij->grad_w, grad);
    rate = dot(v, grad), size *= i->B_size;
  }
  if (o->continuity != ORACLE_NONE && !o->summed) {
    real factor = density_factor(o->continuity, i, j);
    i->drho += factor * rate, i->drho_size += factor * size;
  }
  if (o->pressure == ORACLE_NONE) return;
  real of_i = pressure_factor(o->pressure, i, j), of_j = pressure_factor(o->pressure, j, i);
  real both = i->p * of_i + j->p * of_j, both_size = i->p_size * of_i + j->p_size * of_j;
  if (o->pressure_corrected && !dust)
    corrected_pressure(o, j_is_wall, i, j, ij);
  else {
    for (int k = 0; k < 3; k++) i->a[k] -= j->m * both * ij->grad_w[k];
    i->a_size += j->m * both_size * ij->grad * condition;
  }
  real per_p = density_factor(o->pressure, i, j) / (i->rho * i->rho);
  i->work += per_p * rate, i->work_size += per_p * size; /* times p, or T dp/dT */
}

/* What switches leave of Pi, and its size: alpha and beta are those of the term. */
static real switched(const oracle *o, const oracle_particle *i, const oracle_particle *j, int wall,
                     real *size)
{
  const real alpha = o->signal_alpha > 0 ? o->signal_alpha : o->alpha;
  const real of_i = o->varied ? i->alpha / alpha : 1, of_j = o->varied ? j->alpha / alpha : 1;
  *size = 1;
  if (!o->balsara && !o->varied) return 1;
  *size = wall ? i->f_size * of_i : (i->f_size + j->f_size) / 2 * (of_i + of_j) / 2;
  return wall ? i->f * of_i : (i->f + j->f) / 2 * (of_i + of_j) / 2;
}

/* Monaghan (1992):  a = - sum m_j Pi grad W,  du = 1/2 sum m_j Pi v_ij.grad W,
 * Pi = (-alpha c mu + beta mu^2)/rho where v.r < 0,  mu = h v.r/(r^2 + 0.01 h^2). */
static void viscosity(const oracle *o, oracle_particle *i, const oracle_particle *j, const pair *ij)
{
  real share_size, share = switched(o, i, j, o->group[j->group].wall, &share_size);
  real v[3], h = o->h, rho = (i->rho + j->rho) / 2, c = (i->c + j->c) / 2;
  difference(i->v_viscous, j->v_viscous, v);
  if (dot(v, ij->d) >= 0) return;
  real scale = h / (ij->r * ij->r + 0.01L * h * h), mu = scale * dot(v, ij->d);
  real speed = norm(i->v_viscous) + norm(j->v_viscous), mu_size = scale * speed * ij->r;
  real Pi = share * (-o->alpha * c * mu + o->beta * mu * mu) / rho;
  real Pi_size =
      share_size * (o->alpha * c * mu_size + o->beta * mu_size * mu_size) / rho * j->condition;
  for (int k = 0; k < 3; k++) i->a[k] -= j->m * Pi * ij->grad_w[k];
  i->a_size += j->m * Pi_size * ij->grad;
  i->heat += j->m * Pi * dot(v, ij->grad_w) / 2;
  i->heat_size += j->m * Pi_size * speed * ij->grad / 2;
}

/* Monaghan (1997):  Pi = - alpha/2 (c_i + c_j - beta w) w/rho where w = v.r/r < 0. */
static void signal_viscosity(const oracle *o, oracle_particle *i, const oracle_particle *j,
                             const pair *ij)
{
  real v[3], rho = (i->rho + j->rho) / 2, speed = norm(i->v_viscous) + norm(j->v_viscous);
  real share_size, share = switched(o, i, j, o->group[j->group].wall, &share_size);
  difference(i->v_viscous, j->v_viscous, v);
  real w = dot(v, ij->d) / ij->r;
  if (w >= 0) return;
  real Pi = -share * o->signal_alpha / 2 * (i->c + j->c - o->signal_beta * w) * w / rho;
  real Pi_size = o->signal_alpha / 2 * (i->c + j->c + o->signal_beta * speed) * speed / rho;
  Pi_size *= share_size * i->condition * j->condition;
  for (int k = 0; k < 3; k++) i->a[k] -= j->m * Pi * ij->grad_w[k];
  i->a_size += j->m * Pi_size * ij->grad;
  i->heat += j->m * Pi * dot(v, ij->grad_w) / 2;
  i->heat_size += j->m * Pi_size * speed * ij->grad / 2;
}

/* r^2/(r^2 + 0.01 h^2) for the kernel whose F is singular. */
static real regular(const oracle *o, const pair *ij)
{
  real r2 = ij->r * ij->r;
  return o->kernel == ORACLE_SPIKY ? r2 / (r2 + o->h * o->h / 100) : 1;
}

/* e.B e, B of i or the mean, e = r_ij/r; its size over it. */
static real stretch(const oracle *o, const oracle_particle *i, const oracle_particle *j,
                    const pair *ij, real *condition)
{
  real of_i[3], of_j[3], both, size = i->B_size;
  times(i, ij->d, of_i);
  times(j, ij->d, of_j);
  both = dot(of_i, ij->d);
  if (o->laminar_corrected == ORACLE_PLAIN || ij->r == 0) return 1;
  if (o->laminar_corrected == ORACLE_MEAN) both = (both + dot(of_j, ij->d)) / 2, size += j->B_size;
  *condition = size * ij->r * ij->r / both;
  return both / (ij->r * ij->r);
}

/* Morris (1997):  a = sum m_j (eta_i + eta_j)/(rho_i rho_j) F v_ij;
 * Monaghan, Cleary & Gingold:  a = 2 (d + 2) sum m_j 2 eta_i eta_j/(eta_i + eta_j)/(rho_i rho_j)
 *   (v_ij.r)/r^2 grad W;  both heat by half of their work.  A wall has the viscosity of i. */
static void laminar(const oracle *o, real eta_i, real eta_j, int j_is_wall, oracle_particle *i,
                    const oracle_particle *j, const pair *ij)
{
  real v[3], force[3], per_mass = j->m / (i->rho * j->rho) * regular(o, ij), condition = 1;
  per_mass *= stretch(o, i, j_is_wall ? i : j, ij, &condition);
  real speed = norm(i->v_viscous) + norm(j->v_viscous), size;
  difference(i->v_viscous, j->v_viscous, v);
  if (o->laminar == ORACLE_MORRIS) {
    real factor = per_mass * (eta_i + eta_j) * ij->f;
    for (int k = 0; k < 3; k++) force[k] = factor * v[k];
    size = fabsl(factor) * speed;
  } else {
    real mean = eta_i + eta_j > 0 ? 2 * eta_i * eta_j / (eta_i + eta_j) : 0;
    real factor = 2 * (o->dim + 2) * per_mass * mean / (ij->r * ij->r);
    for (int k = 0; k < 3; k++) force[k] = factor * dot(v, ij->d) * ij->grad_w[k];
    size = factor * speed * ij->r * ij->grad;
  }
  for (int k = 0; k < 3; k++) i->a[k] += force[k];
  condition *= i->condition * j->condition;
  i->a_size += size * condition;
  i->heat -= dot(force, v) / 2;
  i->heat_size += size * speed / 2 * condition;
}

/* Cleary & Monaghan (1999):
 *   du = sum m_j/(rho_i rho_j) 4 kappa_i kappa_j/(kappa_i + kappa_j) (T_i - T_j) F. */
static void heat_conduction(const oracle *o, real k_i, real k_j, oracle_particle *i,
                            const oracle_particle *j, const pair *ij)
{
  if (k_i <= 0 || k_j <= 0) return;
  real factor = j->m / (i->rho * j->rho) * 4 * k_i * k_j / (k_i + k_j) * ij->f * regular(o, ij);
  i->heat += factor * (i->T - j->T);
  i->heat_size += fabsl(factor) * (i->T_size + j->T_size) * i->condition * j->condition;
}

/* Monaghan (1989):  dx/dt = v - epsilon sum m_j/rho v_ij W, rho the mean. */
static void xsph(const oracle *o, oracle_particle *i, const oracle_particle *j, const pair *ij)
{
  real weight = o->epsilon * j->m / ((i->rho + j->rho) / 2) * oracle_w(o, ij->r);
  real edge = 1 + 8 / (1 - ij->r / (kappa(o) * o->h));
  for (int k = 0; k < 3; k++) i->dx[k] -= weight * (i->v[k] - j->v[k]);
  i->dx_size += weight * edge * (norm(i->v) + norm(j->v)) * i->condition * j->condition;
}

/* int q^2 W dV at h = 1, by Gauss's rule of five points. */
static real second_moment(const oracle *o)
{
  static const real node[] = {0, 0.53846931010568309104L, 0.90617984593866399280L};
  static const real weight[] = {0.56888888888888888889L, 0.47862867049936646804L,
                                0.23692688505618908751L};
  const real sphere = o->dim == 1 ? 2 : o->dim == 2 ? 2 * pi : 4 * pi;
  real sum = 0, half = 0.01L;
  for (int k = 0; k < 50 * kappa(o); k++)
    for (int g = -2; g <= 2; g++) {
      real q = (2 * k + 1) * half + (g < 0 ? -1 : 1) * half * node[g < 0 ? -g : g];
      sum += half * weight[g < 0 ? -g : g] * powl(q, o->dim + 1) * shape(o, q);
    }
  return sphere * sigma(o) * sum;
}

/* Laibe & Price (2012):  a = - d sum m_j K/(rho_i rho_j) (v_ij.e) e D,  D = q^2 W/int q^2 W dV;
 * all its work heats the fluid. */
static void drag(const oracle *o, int i_is_dust, oracle_particle *i, const oracle_particle *j,
                 const pair *ij)
{
  real q = ij->r / o->h, D = q * q * oracle_w(o, ij->r) / o->second_moment, v[3];
  real K = o->drag_K + o->drag_rate * (i_is_dust ? i->rho : j->rho);
  real factor = o->dim * j->m * K / (i->rho * j->rho) * D, along = 0;
  real speed = norm(i->v) + norm(j->v);
  real edge = (1 + 8 / (1 - q / kappa(o))) * i->condition * j->condition;
  difference(i->v, j->v, v);
  if (ij->r > 0) along = dot(v, ij->d) / ij->r;
  for (int k = 0; k < o->dim && ij->r > 0; k++) i->a[k] -= factor * along * ij->d[k] / ij->r;
  i->a_size += factor * speed * edge;
  if (!i_is_dust) i->heat += factor * along * along;
  if (!i_is_dust) i->heat_size += factor * speed * speed * edge;
}

/* Price (2008):  du = sum m_j/rho alpha_u v_sig (u_i - u_j) r F,  v_sig = sqrt(|p_i - p_j|/rho). */
static void conductivity(const oracle *o, oracle_particle *i, const oracle_particle *j,
                         const pair *ij)
{
  real rho = (i->rho + j->rho) / 2, jump = fabsl(i->p - j->p);
  if (jump == 0) return;
  real factor = j->m / rho * o->conductivity * sqrtl(jump / rho) * ij->r * ij->f;
  i->heat += factor * (i->u - j->u);
  i->heat_size += fabsl(factor) * (i->u + j->u) * (1 + (i->p_size + j->p_size) / jump);
}

/* drho = delta h c0 sum V_j psi.grad W,
 * Molteni & Colagrossi (2009): psi = 2 (rho_j - rho_i) r_ji/r^2;
 * Antuono et al. (2010): less <grad rho>_i + <grad rho>_j; of a wall, that of i;
 * Fourtakas et al. (2019): rho_j - rho_i - rho^H instead of rho_j - rho_i,
 *   rho^H = rho0 ((1 + rho0 |g| z/B)^(1/gamma) - 1), z = z_i - z_j upwards, B = rho0 c0^2/gamma. */
static void diffusion(const oracle *o, const oracle_eos *eos, int j_is_wall, oracle_particle *i,
                      const oracle_particle *j, const pair *ij)
{
  real factor = o->delta * o->h * eos->c0 * j->m / j->rho, psi[3];
  real size = 2 * (i->rho + j->rho) / ij->r; /* of liquids: condition 1 */
  real jump = j->rho - i->rho;
  if (o->diffusion == ORACLE_FOURTAKAS) {
    real weight = -eos->rho0 * dot(o->g, ij->d); /* rho0 |g| z */
    jump -= eos->rho0 *
            (powl(1 + weight * eos->gamma / (eos->rho0 * eos->c0 * eos->c0), 1 / eos->gamma) - 1);
  }
  for (int k = 0; k < 3; k++) psi[k] = -2 * jump * ij->d[k] / (ij->r * ij->r);
  if (o->diffusion == ORACLE_ANTUONO) {
    const oracle_particle *other = j_is_wall ? i : j;
    for (int k = 0; k < 3; k++) psi[k] -= i->gradient[k] + other->gradient[k];
    size += i->gradient_size + other->gradient_size;
  }
  i->drho += factor * dot(psi, ij->grad_w), i->drho_size += factor * size * ij->grad;
}

/* What has an energy, and with it temperature, heat. */
static int has_energy(const oracle *o, long i)
{
  if (is_dust(o, i)) return 0;
  return o->energy != ORACLE_DEFAULT || eos_of(o, i)->kind == ORACLE_IDEAL_GAS;
}

/* u: p work + heat;  u + v^2/2: and v.a;  A = p/rho^gamma: (gamma - 1) rho^(1-gamma) heat;
 * T: (T dp/dT work + heat)/c_v, of an ideal gas T dp/dT = p.  A liquid is not heated by work. */
static void energy_rate(const oracle *o, const oracle_eos *eos, oracle_particle *i)
{
  int gas = eos->kind == ORACLE_IDEAL_GAS;
  i->du = i->heat + (gas ? i->p * i->work : 0);
  i->du_size = i->heat_size + (gas ? i->p_size * i->work_size : 0);
  if (o->energy == ORACLE_TOTAL) {
    i->du += dot(i->v, i->a);
    i->du_size += norm(i->v) * i->a_size;
  } else if (o->energy == ORACLE_ENTROPY) {
    real factor = (eos->gamma - 1) * powl(i->rho, 1 - eos->gamma);
    i->du = factor * i->heat;
    i->du_size = factor * i->heat_size * i->condition;
  } else if (o->energy == ORACLE_TEMPERATURE) {
    i->du /= eos->c_v;
    i->du_size /= eos->c_v;
  }
}

/* All terms of one pair; what walls take part in is said in docs/theory.md. */
static void pair_rates(oracle *o, long i, long j, const pair *ij)
{
  oracle_particle *it = &o->particle[i];
  const oracle_particle *other = &o->particle[j];
  const oracle_group *own = &o->group[it->group], *theirs = &o->group[other->group];
  int wall_j = theirs->wall, viscous = !wall_j || theirs->no_slip;
  if (!same_species(o, i, j)) {
    if (o->drag && !wall_j && own->dust != theirs->dust) drag(o, own->dust, it, other, ij);
    return;
  }
  compression(o, wall_j, it, other, ij);
  if (own->dust) return;
  /* Liquids: a = epsilon (c0/dx)^2 (R/r - 1) r_ij, R = 0.8 dx. */
  real R = 0.8L * o->dx, c = eos_of(o, i)->kind == ORACLE_IDEAL_GAS ? 0 : eos_of(o, i)->c0;
  real push = theirs->repulsion * (c / o->dx) * (c / o->dx) * (R / ij->r - 1);
  for (int k = 0; k < 3 && push > 0 && o->pressure != ORACLE_NONE; k++)
    it->a[k] += push * ij->d[k], it->a_size += push * R / (R - ij->r) * R;
  if (viscous) viscosity(o, it, other, ij);
  if (viscous && o->signal_alpha > 0) signal_viscosity(o, it, other, ij);
  if (viscous && o->laminar != ORACLE_INVISCID)
    laminar(o, own->viscosity, wall_j ? own->viscosity : theirs->viscosity, wall_j, it, other, ij);
  if (o->conductivity > 0 && !wall_j) conductivity(o, it, other, ij);
  if (o->conduction && (!wall_j || theirs->temperature > 0)) {
    real k_j = wall_j && theirs->conductivity <= 0 ? own->conductivity : theirs->conductivity;
    heat_conduction(o, own->conductivity, k_j, it, other, ij);
  }
  if (o->epsilon > 0 && !wall_j) xsph(o, it, other, ij);
  if (o->diffusion != ORACLE_OFF && same_fluid(o, i, j))
    diffusion(o, eos_of(o, i), wall_j, it, other, ij);
}

static void rates(oracle *o, long i)
{
  oracle_particle *it = &o->particle[i];
  pair ij;
  it->drho = it->work = it->heat = it->du = 0;
  it->drho_size = it->work_size = it->heat_size = it->du_size = 0;
  for (int k = 0; k < 3; k++) it->dx[k] = it->v[k];
  for (int k = 0; k < 3; k++) it->a[k] = o->g[k] - o->omega * o->omega * it->x[k];
  it->dx_size = norm(it->v);
  it->a_size = norm(o->g) + o->omega * o->omega * norm(it->x);
  for (long j = 0; j < o->n; j++)
    if (j != i && near(o, i, j, &ij)) pair_rates(o, i, j, &ij);
  if (has_energy(o, i)) energy_rate(o, eos_of(o, i), it);
}

/* ---- switches of artificial viscosity: Balsara (1995); Morris & Monaghan (1997) with Rosswog's
 * source; Cullen & Dehnen (2010) without their jump.  Gradients over fluid particles:
 *   db^a/dx^b = sum V_j (b_j - b_i)^a (M^-1 grad W)^b;  without M^-1 where an eigenvalue of M is
 *   below 0.4 ---- */

static int seen(const oracle *o, long i, long j, pair *ij)
{
  return j != i && !is_wall(o, j) && same_species(o, i, j) && near(o, i, j, ij);
}

/* b: the velocity, or (of_a) the acceleration. */
static real gradient_of(const oracle *o, long i, int of_a, real L[3][3])
{
  const oracle_particle *it = &o->particle[i];
  real m[3][3] = {{0}}, q[3][3], plain[3][3] = {{0}}, smallest = INFINITY, size = 0;
  pair ij;
  for (long j = 0; j < o->n; j++) {
    const oracle_particle *other = &o->particle[j];
    if (!seen(o, i, j, &ij)) continue;
    const real volume = other->m / other->rho;
    const real *b_i = of_a ? it->a : it->v, *b_j = of_a ? other->a : other->v;
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++) {
        plain[r][c] += volume * (b_j[r] - b_i[r]) * ij.grad_w[c];
        m[r][c] -= volume * ij.d[r] * ij.d[c] * ij.f;
      }
    size += volume * ij.grad * (of_a ? it->a_size + other->a_size : norm(it->v) + norm(other->v)) *
            other->condition;
  }
  eigen(m, q);
  for (int e = 0; e < o->dim; e++) smallest = fminl(smallest, m[e][e]);
  const int corrected = smallest >= 0.4L;
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) {
      L[r][c] = corrected ? 0 : plain[r][c];
      for (int e = 0; corrected && e < o->dim; e++)
        L[r][c] += (plain[r][0] * q[0][e] + plain[r][1] * q[1][e] + plain[r][2] * q[2][e]) *
                   q[c][e] / m[e][e];
    }
  return corrected ? size / smallest : size;
}

static real trace(const real L[3][3]) { return L[0][0] + L[1][1] + L[2][2]; }

static void velocity_gradient(oracle *o, long i)
{
  oracle_particle *it = &o->particle[i];
  pair ij;
  it->L_size = gradient_of(o, i, 0, it->L);
  it->v_sig = it->c;
  for (long j = 0; j < o->n; j++) {
    const oracle_particle *other = &o->particle[j];
    if (!seen(o, i, j, &ij)) continue;
    real v[3];
    difference(it->v, other->v, v);
    it->v_sig = fmaxl(it->v_sig, (it->c + other->c) / 2 - fminl(0, dot(v, ij.d) / ij.r));
  }
  const real curl[3] = {it->L[2][1] - it->L[1][2], it->L[0][2] - it->L[2][0],
                        it->L[1][0] - it->L[0][1]};
  const real all = fabsl(trace(it->L)) + norm(curl) + 1e-4L * it->c / o->h;
  it->f = it->f_size = 1;
  if (o->balsara) it->f = fabsl(trace(it->L)) / all, it->f_size = it->f + it->L_size / all;
}

static real sign(real a) { return (a > 0) - (a < 0); }

static void alpha_rate(oracle *o, long i)
{
  oracle_particle *it = &o->particle[i];
  const real alpha_max = o->signal_alpha > 0 ? o->signal_alpha : o->alpha, h = o->h;
  const real divergence = trace(it->L);
  if (o->varied == ORACLE_MORRIS_MONAGHAN) {
    it->dalpha = -(it->alpha - o->alpha_min) * 0.2L * it->c / h +
                 fmaxl(-divergence, 0) * (alpha_max - it->alpha);
    it->dalpha_size = alpha_max * (it->c / h + it->L_size);
    return;
  }
  real da[3][3], LL = 0, SS = 0, above = 0, below = 0;
  const real G_size = gradient_of(o, i, 1, da);
  for (int r = 0; r < o->dim; r++)
    for (int c = 0; c < o->dim; c++) {
      const real S = (it->L[r][c] + it->L[c][r]) / 2 - (r == c ? divergence / o->dim : 0);
      LL += it->L[r][c] * it->L[c][r];
      SS += S * S;
    }
  for (long j = 0; j < o->n; j++) {
    const oracle_particle *other = &o->particle[j];
    pair ij;
    if (j != i && !seen(o, i, j, &ij)) continue;
    const real mW = other->m * oracle_w(o, j == i ? 0 : ij.r);
    above += sign(trace(other->L)) * mW;
    below += mW;
  }
  const real b = 2 * powl(1 - above / below, 4) * divergence,
             xi = b != 0 ? b * b / (b * b + SS) : 0;
  const real A = xi * fmaxl(-(trace(da) - LL), 0), v = it->v_sig;
  const real local = fmaxl(alpha_max * h * h * A / (v * v + h * h * A), o->alpha_min);
  const real tau = (local > it->alpha ? 0.1L : 10) * h / v;
  const real LL_size = it->L_size * it->L_size;
  const real xi_size = SS + b * b > 0 ? 64 * it->L_size / sqrtl(SS + b * b) : 1;
  const real A_size = G_size + LL_size + xi_size * (fabsl(LL) + A);
  it->dalpha = (local - it->alpha) / tau;
  it->dalpha_size = (alpha_max + it->alpha) / tau * (1 + h * h * A_size / (v * v));
}

static void each_fluid(oracle *o, void (*of)(oracle *o, long i))
{
  for (long i = 0; i < o->n; i++)
    if (!is_wall(o, i) && !is_dust(o, i)) of(o, i);
}

void oracle_evaluate(oracle *o)
{
  o->second_moment = second_moment(o);
  densities(o);
  materials(o);
  for (long i = 0; i < o->n; i++)
    if (is_wall(o, i)) wall(o, i);
  each_fluid(o, gradient);
  if (corrected(o)) each_fluid(o, inverse);
  if (o->balsara || o->varied) each_fluid(o, velocity_gradient);
  for (long i = 0; i < o->n; i++)
    if (!is_wall(o, i)) rates(o, i);
  if (o->varied) each_fluid(o, alpha_rate);
}
