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
  SPH_FORM_C2 = 4,  /* the row of continuity, pressure and heating is C2, */
  SPH_FORM_PHI = 8, /* or that of phi; without both C1 with S */
  SPH_ARTIFICIAL = 16,
  SPH_SIGNAL = 32,
  SPH_MORRIS = 64,
  SPH_MCG = 128,
  SPH_MOLTENI = 256,
  SPH_ANTUONO = 512,
  SPH_FOURTAKAS = 1024,
  SPH_THERMAL = 2048, /* fluids have an energy */
  SPH_CONDUCTIVITY = 4096,
  SPH_CONDUCTION = 8192,
  SPH_XSPH = 16384,
  SPH_WALL = 32768,     /* the source is a wall, */
  SPH_NO_SLIP = 65536,  /* and viscous terms see it */
  SPH_BALSARA = 131072, /* switches of artificial viscosity: term_switch.h */
  SPH_MORRIS_MONAGHAN = 262144,
  SPH_CULLEN_DEHNEN = 524288,
  SPH_STRESS = 1 << 25,
  SPH_QUADRATIC = 1 << 26, /* the artificial viscosity has a beta */
  /* Gradients of these terms are corrected: */
  SPH_CONTINUITY_CORRECTED = 1 << 20,
  SPH_PRESSURE_ONE_SIDED = 1 << 21,
  SPH_PRESSURE_MEAN = 1 << 22,
  SPH_LAMINAR_ONE_SIDED = 1 << 23,
  SPH_LAMINAR_MEAN = 1 << 24,
  SPH_PRESSURE_CORRECTED = SPH_PRESSURE_ONE_SIDED | SPH_PRESSURE_MEAN,
  SPH_LAMINAR_CORRECTED = SPH_LAMINAR_ONE_SIDED | SPH_LAMINAR_MEAN,
  SPH_CORRECTED = SPH_CONTINUITY_CORRECTED | SPH_PRESSURE_CORRECTED | SPH_LAMINAR_CORRECTED,
  SPH_DIFFUSION = SPH_MOLTENI | SPH_ANTUONO | SPH_FOURTAKAS,
  SPH_VISCOUS = SPH_ARTIFICIAL | SPH_SIGNAL | SPH_MORRIS | SPH_MCG,
  SPH_SWITCHES = SPH_BALSARA | SPH_MORRIS_MONAGHAN | SPH_CULLEN_DEHNEN,
  SPH_RARE = SPH_FORM_PHI | SPH_SIGNAL | SPH_MORRIS | SPH_MCG | SPH_FOURTAKAS | SPH_CONDUCTION |
             SPH_XSPH | SPH_STRESS | SPH_SWITCHES | SPH_CORRECTED
};

/* Corrections of those terms that are there. */
BODY unsigned fluid_corrections(unsigned terms)
{
  unsigned corrections = terms & SPH_CORRECTED;
  if (!(terms & SPH_CONTINUITY)) corrections &= ~(unsigned)SPH_CONTINUITY_CORRECTED;
  if (!(terms & SPH_PRESSURE_FORCE)) corrections &= ~(unsigned)SPH_PRESSURE_CORRECTED;
  if (!(terms & (SPH_MORRIS | SPH_MCG))) corrections &= ~(unsigned)SPH_LAMINAR_CORRECTED;
  return corrections;
}

/* A record, in slots: x[dim] v[dim] rho p c V extra[dim] u T phi alpha f, then B or scalars of
 * tiles.
 *   p: the pressure (C2), p/rho^2 (S) or phi p/rho^2;
 *   extra: <grad rho>^L of a fluid, the velocity that viscous terms see of a wall;
 *   alpha: of artificial viscosity, over that of the term;  f: Balsara's factor;
 *   B: the inverse gradient matrix of a fluid, its upper triangle by rows.
 * Images behind mirrors have alpha, f and B of their particles, other walls none. */
BODY int slot_v(int dim) { return dim; }
BODY int slot_rho(int dim) { return 2 * dim; }
BODY int slot_p(int dim) { return 2 * dim + 1; }
BODY int slot_c(int dim) { return 2 * dim + 2; }
BODY int slot_V(int dim) { return 2 * dim + 3; }
BODY int slot_extra(int dim) { return 2 * dim + 4; }
BODY int slot_u(int dim) { return 3 * dim + 4; }
BODY int slot_T(int dim) { return 3 * dim + 5; }
BODY int slot_phi(int dim) { return 3 * dim + 6; }
BODY int slot_alpha(int dim) { return 3 * dim + 7; }
BODY int slot_f(int dim) { return 3 * dim + 8; }
BODY int slot_scalar(int dim) { return 3 * dim + 9; }
BODY int slot_B(int dim) { return 3 * dim + 9; }
BODY int fluid_B(int dim) { return dim * (dim + 1) / 2; } /* numbers of B */
/* Slots of a record: as few as the terms read. */
BODY int fluid_slots(int dim, unsigned terms, int scalars)
{
  if (scalars) return slot_scalar(dim) + scalars;
  if (terms & SPH_CORRECTED) return slot_B(dim) + fluid_B(dim);
  if (terms & SPH_SWITCHES) return slot_f(dim) + 1;
  if (terms & SPH_FORM_PHI) return slot_phi(dim) + 1;
  if (terms & SPH_THERMAL) return slot_T(dim) + 1;
  return terms & (SPH_ANTUONO | SPH_WALL) ? 3 * dim + 4 : 2 * dim + 4;
}

/* What the pair sums of a fluid particle are; rates follow in sim_pairs.c.  The last ones only for
 * XSPH; behind them the scalars of tiles. */
enum {
  SPH_SUM_A = 0,
  SPH_SUM_COMPRESSION = 3,
  SPH_SUM_DIFFUSION,
  SPH_SUM_HEAT,
  SPH_SUM_DRIFT,
  SPH_FLUID_SUMS = SPH_SUM_DRIFT,
  SPH_FLUID_SUMS_ALL = SPH_SUM_DRIFT + 3
};

enum { SPH_FOURTAKAS_TERMS = 8 }; /* of the series of its hydrostatic density */

/* Of one interaction (target group, source group).  Behind terms vec_scalar only: the tangent loops
 * (tangent_loops.h) take these numbers with their derivatives. */
typedef struct fluid_constants {
  unsigned terms;
  int kernel; /* for loops that are not compiled for one */
  vec_scalar inverse_h;
  vec_scalar eta2;                     /* 0.01 h^2 [m^2] */
  vec_scalar viscosity_1, viscosity_2; /* -alpha h [m], 2 beta h^2 [m^2] */
  vec_scalar signal_1, signal_2;       /* -alpha, beta of the signal velocity */
  vec_scalar laminar;                  /* Morris: eta_i + eta_j; MCG: 4 (d + 2) eta_i eta_j/(eta_i +
                                      eta_j) [Pa s] */
  vec_scalar conduction;               /* 4 kappa_i kappa_j/(kappa_i + kappa_j) [W/(m K)] */
  vec_scalar alpha_u;                  /* artificial conductivity */
  vec_scalar epsilon;                  /* XSPH */
  vec_scalar drag, drag_i, drag_j;     /* drag_pair.h */
  vec_scalar rho0;                     /* Fourtakas: reference density [kg/m^3], */
  vec_scalar column[3];                /* -gamma g/c0^2 [1/m], */
  vec_scalar series[SPH_FOURTAKAS_TERMS];     /* (1/gamma - k)/(k + 1) */
  vec_scalar stress_tension, stress_pressure; /* artificial stress: alpha, beta, */
  vec_scalar inverse_w_dx;                    /* 1/w(dx/h) */
  vec_scalar repulsion, range;                /* of a wall: term_repulsion.h */
  vec_scalar omega[3];                        /* of a wall that turns, for wall_pair.h [1/s] */
  vec_scalar own, other; /* shares of i and j in means of switches: 1, 0 at walls of particles */
} fluid_constants;
enum { SPH_FLUID_NUMBERS = (sizeof(fluid_constants) - sizeof(double)) / sizeof(vec_scalar) };

/* The task as an instance takes it: in single precision with constants of its own. */
typedef struct fluid_task_single {
  sph_pair_task task;
  fluid_constants constants;
} fluid_task_single;

BODY const sph_pair_task *fluid_task(const sph_pair_task *t, fluid_task_single *own)
{
#ifdef SPH_VEC_FLOAT
  const double *from = (const double *)t->constants + 1; /* behind terms and kernel */
  vec_scalar *to = &own->constants.inverse_h;
  memcpy(&own->constants, t->constants, sizeof(double));
  for (int n = 0; n < SPH_FLUID_NUMBERS; n++) to[n] = (vec_scalar)from[n];
  own->task = *t;
  own->task.constants = &own->constants;
  return &own->task;
#else
  (void)own;
  return t;
#endif
}

typedef struct particle {
  vec x[3], v[3], rho, p, c, V, extra[3], u, T, phi, alpha, f;
} particle;

typedef struct pair {
  vec r[3], r2, distance, rv;   /* r.v */
  vec v_viscous[3], rv_viscous; /* v, r.v as viscous terms see them: others at no-slip walls */
  vec F, VF, mF;                /* F, V_j F, m_j F */
  vec stretch;                  /* e.B e, e = r/|r|, for the viscosity of fluids; or 1 */
  vec push;                     /* pressure acceleration of i so far: VF push * r */
  vec along_r, along_v;         /* dissipative one so far: VF (along_r * r + along_v * v_viscous) */
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
  if (terms & SPH_CONDUCTION) a.T = slot[slot_T(dim)];
  if (terms & SPH_FORM_PHI) a.phi = slot[slot_phi(dim)];
  if (terms & SPH_SWITCHES) a.alpha = slot[slot_alpha(dim)], a.f = slot[slot_f(dim)];
  return a;
}

/* The pressure, whatever the row keeps in its slot. */
BODY vec fluid_pressure(unsigned terms, const particle *a)
{
  if (terms & SPH_FORM_C2) return a->p;
  vec p = a->p * a->rho * a->rho;
  return terms & SPH_FORM_PHI ? p / a->phi : p;
}

BODY vec fluid_dot(int dim, const vec *a, const vec *b)
{
  vec sum = a[0] * b[0];
  for (int d = 1; d < dim; d++) sum += a[d] * b[d];
  return sum;
}

/* A particle with itself divides zero by it. */
BODY vec fluid_apart(vec a) { return v_max(a, v_tiny()); }

BODY pair fluid_pair_common(int dim, int kernel, unsigned terms, const fluid_constants *k,
                            const particle *i, const particle *j)
{
  pair p;
  vec v[3];
  for (int d = 0; d < dim; d++) {
    p.r[d] = i->x[d] - j->x[d];
    p.v_viscous[d] = v[d] = i->v[d] - j->v[d];
  }
  p.r2 = fluid_dot(dim, p.r, p.r);
  p.rv = p.rv_viscous = fluid_dot(dim, p.r, v);
  if ((terms & SPH_NO_SLIP) && (terms & SPH_VISCOUS)) {
    for (int d = 0; d < dim; d++) p.v_viscous[d] = i->v[d] - j->extra[d];
    p.rv_viscous = fluid_dot(dim, p.r, p.v_viscous);
  }
  p.distance = v_sqrt(p.r2);
  p.F = kernel_shape_f_at(kernel, dim, p.distance, k->inverse_h);
  p.VF = p.F * j->V;
  p.mF = p.VF * j->rho;
  p.stretch = v_set(1);
  p.push = p.along_r = p.along_v = v_set(0);
  return p;
}

/* r^2/(r^2 + eta^2) for a kernel whose F is singular, else 1. */
BODY vec fluid_regular(int kernel, const fluid_constants *k, const pair *p)
{
  return kernel_shape_singular(kernel) ? p->r2 / (p->r2 + k->eta2) : v_set(1);
}

/* Closes a pair: forces are summed, and the dissipative ones heat both ends with half of their
 * work. */
BODY void fluid_pair_forces(int dim, unsigned terms, const pair *p, vec *sum)
{
  vec central = p->VF * (p->push + p->along_r), drag = p->VF * p->along_v;
  for (int d = 0; d < dim; d++) sum[SPH_SUM_A + d] += central * p->r[d];
  if (terms & SPH_MORRIS)
    for (int d = 0; d < dim; d++) sum[SPH_SUM_A + d] += drag * p->v_viscous[d];
  if (!(terms & SPH_THERMAL)) return;
  vec work = p->along_r * p->rv_viscous;
  if (terms & SPH_MORRIS) work += p->along_v * fluid_dot(dim, p->v_viscous, p->v_viscous);
  sum[SPH_SUM_HEAT] -= 0.5 * p->VF * work;
}

#endif
