/* fluid_pair.h -- what all terms of a pair share.  Term files see only this: a pair, two particles,
 * the constants.
 *
 *   r = x_i - x_j,  v = v_i - v_j,  grad_i W = r F,  F = W'/r <= 0
 *
 * F is used up to its constant factor sigma_d/h^(d+2): all sums are linear in F and scaled once at
 * the end. */
#ifndef SPH_FLUID_PAIR_H
#define SPH_FLUID_PAIR_H
#include "sphode/kernel_shape.h"
#include "sphode/pair_loop.h"

/* Which terms act on a pair: a constant in the fast instances, read at run time in the one for any
 * set. */
enum {
  SPH_CONTINUITY = 1,
  SPH_PRESSURE_FORCE = 2,
  SPH_FORM_C2 = 4, /* the row of continuity, pressure and heating: C2; without it C1 with S */
  SPH_ARTIFICIAL = 8,
  SPH_MOLTENI = 16,
  SPH_ANTUONO = 32,
  SPH_THERMAL = 64,
  SPH_CONDUCTIVITY = 128,
  SPH_WALL = 256 /* the source is a wall */
};

/* A record, in slots: x[dim] v[dim] rho p c V extra[dim] u.
 *   p: the pressure (C2) or p/rho^2 (S);
 *   extra: <grad rho>^L of a fluid, the velocity that viscous terms see of a wall. */
BODY int slot_v(int dim) { return dim; }
BODY int slot_rho(int dim) { return 2 * dim; }
BODY int slot_p(int dim) { return 2 * dim + 1; }
BODY int slot_c(int dim) { return 2 * dim + 2; }
BODY int slot_V(int dim) { return 2 * dim + 3; }
BODY int slot_extra(int dim) { return 2 * dim + 4; }
BODY int slot_u(int dim) { return 3 * dim + 4; }
/* Slots of a record: as few as the terms read. */
BODY int fluid_slots(int dim, unsigned terms)
{
  if (terms & SPH_THERMAL) return 3 * dim + 5;
  return terms & (SPH_ANTUONO | SPH_WALL) ? 3 * dim + 4 : 2 * dim + 4;
}

/* What the pair sums of a fluid particle are; rates follow in fluid_rates.c. */
enum { SPH_SUM_A = 0, SPH_SUM_COMPRESSION = 3, SPH_SUM_DIFFUSION, SPH_SUM_HEAT, SPH_FLUID_SUMS };

typedef struct fluid_constants {
  unsigned terms;
  double inverse_h;
  double eta2;                     /* 0.01 h^2 [m^2] */
  double viscosity_1, viscosity_2; /* -alpha h [m], 2 beta h^2 [m^2] */
  double alpha_u;                  /* artificial conductivity */
} fluid_constants;

typedef struct particle {
  vec x[3], v[3], rho, p, c, V, extra[3], u;
} particle;

typedef struct pair {
  vec r[3], r2, distance, rv; /* r.v */
  vec rv_viscous;             /* r.v as viscous terms see it: another one at no-slip walls */
  vec F, VF, mF;              /* F, V_j F, m_j F */
  vec push;                   /* pressure acceleration of i so far: push * r */
  vec along_r;                /* dissipative acceleration of i so far: along_r * r */
} pair;

BODY particle fluid_particle(int dim, unsigned terms, const vec *slot)
{
  particle a;
  for (int d = 0; d < dim; d++) {
    a.x[d] = slot[d];
    a.v[d] = slot[slot_v(dim) + d];
    if (terms & (SPH_ANTUONO | SPH_WALL)) a.extra[d] = slot[slot_extra(dim) + d];
  }
  a.rho = slot[slot_rho(dim)];
  a.p = slot[slot_p(dim)];
  a.c = slot[slot_c(dim)];
  a.V = slot[slot_V(dim)];
  if (terms & SPH_THERMAL) a.u = slot[slot_u(dim)];
  return a;
}

BODY vec fluid_dot(int dim, const vec *a, const vec *b)
{
  vec sum = a[0] * b[0];
  for (int d = 1; d < dim; d++) sum += a[d] * b[d];
  return sum;
}

BODY pair fluid_pair_common(int dim, int kernel, unsigned terms, const fluid_constants *k,
                            const particle *i, const particle *j)
{
  pair p;
  vec v[3];
  for (int d = 0; d < dim; d++) {
    p.r[d] = i->x[d] - j->x[d];
    v[d] = i->v[d] - j->v[d];
  }
  p.r2 = fluid_dot(dim, p.r, p.r);
  p.rv = p.rv_viscous = fluid_dot(dim, p.r, v);
  if ((terms & SPH_WALL) && (terms & SPH_ARTIFICIAL)) {
    for (int d = 0; d < dim; d++) v[d] = i->v[d] - j->extra[d];
    p.rv_viscous = fluid_dot(dim, p.r, v);
  }
  p.distance = v_sqrt(p.r2);
  p.F = kernel_shape_f(kernel, dim, p.distance * k->inverse_h);
  p.VF = p.F * j->V;
  p.mF = p.VF * j->rho;
  p.push = p.along_r = v_set(0);
  return p;
}

/* Closes a pair: forces are summed, and the dissipative ones heat both ends with half of their
 * work. */
BODY void fluid_pair_forces(int dim, unsigned terms, const pair *p, vec *sum)
{
  for (int d = 0; d < dim; d++) sum[SPH_SUM_A + d] += (p->push + p->along_r) * p->r[d];
  if (terms & SPH_THERMAL) sum[SPH_SUM_HEAT] -= 0.5 * p->along_r * p->rv_viscous;
}

#endif
