/* Mirror walls: each fluid particle within the reach of a plane has an image behind it, a ghost,
 * and at edges and corners one for each set of planes that it is near to (repeated reflection).
 *
 *   r_g = r - 2 [(r - x_b).n] n,   V_g = V, c, u and the like as of its fluid particle,
 *   v_g = v - 2 [(v - v_b).n] n;   in viscous terms of a no-slip wall 2 v_b - v,
 *   p_g = p + rho (g - a_b).(r_g - r),   rho_g = rho + (p_g - p)/c^2 of a liquid,
 *   T_g = 2 T_b - T (isothermal), T + 2 d q/kappa (flux q into the fluid), T (adiabatic),
 *   T_b and q those at the foot of the perpendicular, r - d n.
 *
 * Morris, Fox & Zhu (1997); Colagrossi & Landrini (2003).  rho_g goes on with the column at rest,
 * as p_g does: with rho_g = rho density diffusion would see a kink at the wall.  Ghosts are made
 * when lists are built, of all particles nearer than the support and the skin, and filled at each
 * evaluation: f depends on the state alone.  What crosses a plane within a step meets its own image
 * in its place: both have changed roles, which is undone at the end of the step. */
#include "sim_mirror.h"

#include <math.h>
#include <string.h>

#include "memory.h"
#include "sim_prepare.h"

enum { PARALLEL_MIN = 1024 };

/* A plane where it stands at the time of an evaluation. */
typedef struct mirror {
  double point[3], normal[3], v[3], force[3]; /* v_b; g - a_b */
  int no_slip;
} mirror;

static double dot(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static int is_mirror(const sph_group *group)
{
  return group->wall && group->model == SPH_MODEL_MIRROR;
}

/* ---- before the run ---- */

int sph_sim_mirror_take(sph_sim *sim, const sph_group *group, sph_boundary *boundary)
{
  if (strcmp(boundary->name, "mirror"))
    return boundary->planes == 0 && boundary->heat_flux == 0 && !boundary->heat_flux_at
               ? SPH_OK
               : sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                              "group %s: planes and a heat flux are of boundary mirror, not of %s",
                              group->name, boundary->name);
  if (boundary->planes < 1 || boundary->planes > SPH_PLANES_MAX)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "group %s: a mirror of %d planes or more; right is 1 to %d", group->name,
                        boundary->planes, SPH_PLANES_MAX);
  if (boundary->rotation)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "group %s: mirrors do not turn; right are adami and dbc", group->name);
  if (boundary->heat_flux_at && (boundary->temperature > 0 || boundary->temperature_at))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "group %s: a heat flux and a temperature; right is one of them",
                        group->name);
  if (!isfinite(boundary->heat_flux) ||
      (boundary->heat_flux != 0 && (boundary->temperature > 0 || boundary->temperature_at)))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "group %s: a heat flux of %g W/m^2 and a temperature of %g K; right is one "
                        "of them, finite",
                        group->name, boundary->heat_flux, boundary->temperature);
  for (int k = 0; k < boundary->planes; k++) {
    double *n = boundary->plane[k].normal, length = sqrt(dot(n, n));
    if (!(length > 0 && length < INFINITY) || !isfinite(dot(boundary->plane[k].point, n)))
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "group %s: plane %d has the normal (%g, %g, %g); right is a finite one, "
                          "not zero (sides of a box are x- x+ y- y+ z- z+)",
                          group->name, k, n[0], n[1], n[2]);
    for (int d = 0; d < 3; d++) n[d] /= length;
  }
  return SPH_OK;
}

/* Two planes: at right angles, or face to face with room for the support between them. */
static int fit(sph_sim *sim, const sph_group *a, int k, const sph_group *b, int l)
{
  const sph_plane *p = &a->boundary.plane[k], *q = &b->boundary.plane[l];
  double between[3], cosine = dot(p->normal, q->normal), reach = sim->H + sim->skin;
  for (int d = 0; d < 3; d++) between[d] = q->point[d] - p->point[d];
  if (fabs(cosine) < 1e-9) return SPH_OK;
  if (cosine < -1 + 1e-9 && dot(between, p->normal) >= reach) return SPH_OK;
  return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                      "planes %d of %s and %d of %s: mirrors stand at right angles, or face to "
                      "face at least the support and the skin, %g m, apart",
                      k, a->name, l, b->name, reach);
}

static int fit_all(sph_sim *sim, int g, int k)
{
  const sph_group *group = sim->group[g];
  int status = SPH_OK;
  for (int o = 0; o <= g; o++)
    for (int l = 0; !status && l < sim->group[o]->boundary.planes && (o < g || l < k); l++)
      status = fit(sim, group, k, sim->group[o], l);
  return status;
}

/* Every fluid particle in front of the plane? */
static int in_front(sph_sim *sim, const sph_group *group, const sph_plane *plane)
{
  for (int f = 0; f < sim->groups; f++)
    for (long i = 0; !sim->group[f]->wall && !sim->group[f]->eos.dust && i < sim->group[f]->n;
         i++) {
      double d = 0;
      for (int c = 0; c < sim->dim; c++)
        d += (sim->group[f]->own[SPH_POSITION][c][i] - plane->point[c]) * plane->normal[c];
      if (!(d > 0))
        return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                            "%s, particle %ld: starts %g m behind a plane of mirror %s",
                            sim->group[f]->name, i, -d, group->name);
    }
  return SPH_OK;
}

static int one_liquid(sph_sim *sim, const sph_group *group)
{
  for (int f = 0; f < sim->groups; f++)
    if (!sim->group[f]->wall && !sim->group[f]->eos.dust &&
        !sph_sim_interaction_same_fluid(sim->group[f], group))
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "mirror %s: %s is another liquid; right are adami walls where two of "
                          "them meet density diffusion (delta) or a density reset",
                          group->name, sim->group[f]->name);
  return SPH_OK;
}

int sph_sim_mirror_one_liquid(sph_sim *sim)
{
  int status = SPH_OK;
  for (int g = 0; !status && g < sim->groups; g++)
    if (sim->group[g]->model == SPH_MODEL_MIRROR) status = one_liquid(sim, sim->group[g]);
  return status;
}

static int check(sph_sim *sim, int g)
{
  sph_group *group = sim->group[g];
  int status = group->n
                   ? sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                                  "mirror %s has particles; right are planes alone", group->name)
               : sim->terms.bits & SPH_DIFFUSION ? one_liquid(sim, group)
                                                 : SPH_OK;
  for (int k = 0; !status && k < group->boundary.planes; k++) {
    const sph_plane *plane = &group->boundary.plane[k];
    for (int d = 0; d < 3; d++)
      if (plane->normal[d] != 0 && (d >= sim->dim || sim->periodic[d]))
        return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                            "mirror %s: the normal of plane %d points along %c, which is %s",
                            group->name, k, "xyz"[d],
                            d >= sim->dim ? "no direction of this simulation" : "periodic");
    status = fit_all(sim, g, k);
    if (!status) status = in_front(sim, group, plane);
  }
  if (!status && sim->needs_temperature)
    status = sph_group_data_own(group, SPH_TEMPERATURE, &sim->error);
  return status;
}

int sph_sim_mirror_check(sph_sim *sim)
{
  int status = SPH_OK;
  for (int g = 0; !status && g < sim->groups; g++)
    if (is_mirror(sim->group[g])) status = check(sim, g);
  return status;
}

/* ---- at list builds ---- */

static void displacement_of(const sph_group *group, double t, double displacement[3])
{
  double v[3], a[3];
  memset(displacement, 0, 3 * sizeof *displacement);
  if (group->boundary.motion) group->boundary.motion(group->boundary.ctx, t, displacement, v, a);
}

void sph_sim_mirror_stand(sph_sim *sim, double t)
{
  for (int g = 0; g < sim->groups; g++)
    if (is_mirror(sim->group[g])) displacement_of(sim->group[g], t, sim->group[g]->placed);
}

int sph_sim_mirror_moved(const sph_sim *sim, double t)
{
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    double at[3], moved = 0;
    if (!is_mirror(group) || !group->boundary.motion) continue;
    displacement_of(group, t, at);
    for (int d = 0; d < 3; d++) moved += (at[d] - group->placed[d]) * (at[d] - group->placed[d]);
    if (!(moved <= sim->skin * sim->skin / 16)) return 1;
  }
  return 0;
}

/* Distance of x in front of plane k of mirror m, as it stood at the build. */
static double distance(const sph_group *m, int k, const double x[3])
{
  const sph_plane *plane = &m->boundary.plane[k];
  double d = 0;
  for (int c = 0; c < 3; c++) d += (x[c] - plane->point[c] - m->placed[c]) * plane->normal[c];
  return d;
}

/* Planes near a particle, and how near; face to face is never more than one of them. */
typedef struct near {
  int n, group[SPH_PLANES_MAX], plane[SPH_PLANES_MAX];
  double d[SPH_PLANES_MAX];
} near;

static near planes_near(const sph_sim *sim, const double x[3])
{
  const double reach = sim->H + sim->skin;
  near found = {0};
  for (int g = 0; g < sim->groups; g++)
    for (int k = 0; is_mirror(sim->group[g]) && k < sim->group[g]->boundary.planes; k++) {
      double d = distance(sim->group[g], k, x);
      if (!(d < reach) || found.n == SPH_PLANES_MAX) continue;
      found.group[found.n] = g;
      found.plane[found.n] = k;
      found.d[found.n++] = d;
    }
  return found;
}

/* The mirror that a ghost belongs to: the first of its planes, of no slip if there is one. */
static int home_of(const sph_sim *sim, const sph_ghost *ghost)
{
  for (int k = 0; k < ghost->planes; k++)
    if (sim->group[ghost->in[k].group]->boundary.no_slip) return ghost->in[k].group;
  return ghost->in[0].group;
}

/* Ghost number n of mirror `home`; its place at the build is x. */
static int append(sph_sim *sim, const sph_ghost *ghost, const double x[3])
{
  sph_group *home = sim->group[home_of(sim, ghost)];
  sph_sorted *sorted = &sim->sorted[home->index];
  int status = sph_group_data_reserve(home, home->n + 1, &sim->error);
  if (!status) status = sph_sim_prepare_room(sim, home->index);
  if (status) return status;
  for (int d = 0; d < sim->dim && d < 3; d++) sorted->built[d][home->n] = x[d];
  home->id[home->n] = sph_group_data_id(sim->group[ghost->group], ghost->parent);
  home->ghost[home->n++] = *ghost;
  return SPH_OK;
}

/* All sets of near planes, none of them parallel, within reach of which the particle is. */
static int reflect_sets(sph_sim *sim, sph_ghost *ghost, const near *at, const double x[3])
{
  const double reach2 = (sim->H + sim->skin) * (sim->H + sim->skin);
  for (int set = 1; set < 1 << at->n; set++) {
    double image[3] = {x[0], x[1], x[2]}, d2 = 0;
    int parallel = 0;
    ghost->planes = 0;
    for (int k = 0; k < at->n && !parallel; k++) {
      if (!(set >> k & 1)) continue;
      const double *n = sim->group[at->group[k]]->boundary.plane[at->plane[k]].normal;
      for (int q = 0; q < ghost->planes; q++)
        parallel |=
            fabs(
                dot(n, sim->group[ghost->in[q].group]->boundary.plane[ghost->in[q].plane].normal)) >
            0.5;
      if (parallel) break;
      ghost->in[ghost->planes].group = (unsigned char)at->group[k];
      ghost->in[ghost->planes++].plane = (unsigned char)at->plane[k];
      for (int d = 0; d < 3; d++) image[d] -= 2 * at->d[k] * n[d];
      d2 += at->d[k] * at->d[k];
    }
    if (parallel || d2 >= reach2) continue;
    int status = append(sim, ghost, image);
    if (status) return status;
  }
  return SPH_OK;
}

static int make_of(sph_sim *sim, int g)
{
  double *const *built = sim->sorted[g].built;
  int status = SPH_OK;
  for (long i = 0; !status && i < sim->group[g]->n; i++) {
    double x[3] = {0};
    for (int d = 0; d < sim->dim; d++) x[d] = built[d][i];
    const near at = planes_near(sim, x);
    sph_ghost ghost = {.parent = i, .group = g};
    if (at.n) status = reflect_sets(sim, &ghost, &at, x);
  }
  return status;
}

int sph_sim_mirror_make(sph_sim *sim)
{
  int mirrors = 0, status = SPH_OK;
  for (int g = 0; g < sim->groups; g++)
    if (is_mirror(sim->group[g])) {
      sim->group[g]->n = 0;
      mirrors++;
    }
  for (int g = 0; mirrors && !status && g < sim->groups; g++)
    if (!sim->group[g]->wall && !sim->group[g]->eos.dust) status = make_of(sim, g);
  return status;
}

void sph_sim_mirror_find(sph_sim *sim)
{
  for (int g = 0; g < sim->groups; g++) {
    const int *order = sph_neighbors_order(sim->neighbors, g);
    for (long s = 0; sim->sorted[g].place && s < sim->group[g]->n; s++)
      sim->sorted[g].place[order[s]] = (int)s;
  }
}

/* ---- in each evaluation ---- */

static mirror stand(const sph_evaluation *e, const sph_group *group, int k)
{
  const sph_boundary *b = &group->boundary;
  mirror m = {.no_slip = b->no_slip};
  double displacement[3] = {0}, a[3] = {0};
  if (b->motion) b->motion(b->ctx, e->t, displacement, m.v, a);
  for (int d = 0; d < 3; d++) {
    m.normal[d] = b->plane[k].normal[d];
    m.point[d] = b->plane[k].point[d] + displacement[d];
    m.force[d] = e->sim->terms.g[d] - a[d];
  }
  return m;
}

/* All mirrors of one evaluation, by group and plane. */
typedef struct mirrors {
  mirror of[SPH_SETS_MAX][SPH_PLANES_MAX];
} mirrors;

static void stand_all(const sph_evaluation *e, mirrors *all)
{
  for (int g = 0; g < e->sim->groups; g++)
    for (int k = 0; is_mirror(e->sim->group[g]) && k < e->sim->group[g]->boundary.planes; k++)
      all->of[g][k] = stand(e, e->sim->group[g], k);
}

static void take(int dim, double *const *from, long i, double to[3])
{
  for (int d = 0; d < 3; d++) to[d] = d < dim ? from[d][i] : 0;
}

static void give(int dim, const double from[3], double *const *to, long i)
{
  for (int d = 0; d < dim && d < 3; d++) to[d][i] = from[d];
}

static void reflect(const double n[3], const double about[3], double a[3])
{
  double along = 0;
  for (int d = 0; d < 3; d++) along += (a[d] - about[d]) * n[d];
  for (int d = 0; d < 3; d++) a[d] -= 2 * along * n[d];
}

int sph_sim_mirror_slips(const sph_group *group)
{
  return is_mirror(group) && !group->boundary.no_slip;
}

long sph_sim_mirror_parent(const sph_sim *sim, const sph_ghost *ghost)
{
  return sim->sorted[ghost->group].place[ghost->parent];
}

void sph_sim_mirror_turn(const sph_sim *sim, const sph_ghost *ghost, double *a)
{
  double turned[3] = {0};
  const double zero[3] = {0};
  for (int d = 0; d < sim->dim; d++) turned[d] = a[d];
  for (int k = 0; k < ghost->planes; k++)
    reflect(sim->group[ghost->in[k].group]->boundary.plane[ghost->in[k].plane].normal, zero,
            turned);
  for (int d = 0; d < sim->dim; d++) a[d] = turned[d];
}

/* The record of a ghost's particle. */
static const double *parent_record(const sph_sim *sim, const sph_ghost *ghost)
{
  const sph_sorted *sorted = &sim->sorted[ghost->group];
  return sorted->record + sph_sim_mirror_parent(sim, ghost) * sorted->stride;
}

/* What a ghost takes of its particle's record: slots from ... to - 1. */
typedef void taking(const sph_sim *sim, const sph_ghost *ghost, const double *parent, double *own,
                    int from, int to);

static void take_all(const sph_sim *sim, taking *one, int from, int to)
{
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    const int *order = sph_neighbors_order(sim->neighbors, g);
    if (!is_mirror(group)) continue;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (group->n > PARALLEL_MIN)
    for (long s = 0; s < group->n; s++) {
      const sph_ghost *ghost = &group->ghost[order[s]];
      one(sim, ghost, parent_record(sim, ghost), sim->sorted[g].record + s * sim->sorted[g].stride,
          from, to);
    }
  }
}

static void copy(const sph_sim *sim, const sph_ghost *ghost, const double *parent, double *own,
                 int from, int to)
{
  (void)sim, (void)ghost;
  for (int k = from; k < to; k++) own[k] = parent[k];
}

void sph_sim_mirror_copy(const sph_sim *sim, int from, int to) { take_all(sim, copy, from, to); }

/* Both indices are turned, one after the other. */
static void turn_matrix(const sph_sim *sim, const sph_ghost *ghost, const double *parent,
                        double *own, int from, int to)
{
  double A[3][3], column[3];
  const int dim = sim->dim;
  const double *B = parent + from;
  (void)to;
  for (int a = 0; a < dim; a++)
    for (int b = a; b < dim; b++) A[a][b] = A[b][a] = *B++;
  for (int a = 0; a < dim; a++) sph_sim_mirror_turn(sim, ghost, A[a]);
  for (int b = 0; b < dim; b++) {
    for (int a = 0; a < dim; a++) column[a] = A[a][b];
    sph_sim_mirror_turn(sim, ghost, column);
    for (int a = 0; a < dim; a++) A[a][b] = column[a];
  }
  for (int a = 0; a < dim; a++)
    for (int b = a; b < dim; b++) own[from++] = A[a][b];
}

void sph_sim_mirror_matrices(const sph_sim *sim)
{
  const int slot = slot_B(sim->dim);
  take_all(sim, turn_matrix, slot, slot + sim->dim * (sim->dim + 1) / 2);
}

static void place(const sph_evaluation *e, const mirrors *all, const sph_group *group, long i)
{
  const sph_ghost *ghost = &group->ghost[i];
  const sph_view *parent = &e->view[ghost->group], *own = &e->view[group->index];
  const int dim = e->sim->dim;
  double x[3], v[3], seen[3];
  take(dim, parent->x, ghost->parent, x);
  take(dim, parent->v, ghost->parent, v);
  memcpy(seen, v, sizeof seen);
  for (int k = 0; k < ghost->planes; k++) {
    const mirror *m = &all->of[ghost->in[k].group][ghost->in[k].plane];
    reflect(m->normal, m->point, x);
    reflect(m->normal, m->v, v);
    if (m->no_slip)
      for (int d = 0; d < 3; d++) seen[d] = 2 * m->v[d] - seen[d];
    else
      reflect(m->normal, m->v, seen);
  }
  give(dim, x, own->x, i);
  give(dim, v, own->v, i);
  give(dim, seen, group->start, i);
  own->m[i] = parent->m[ghost->parent];
}

void sph_sim_mirror_place(const sph_evaluation *e, int g)
{
  const sph_group *group = e->sim->group[g];
  mirrors all;
  stand_all(e, &all);
#pragma omp parallel for num_threads(e->sim->threads) schedule(static) if (group->n > PARALLEL_MIN)
  for (long i = 0; i < group->n; i++) place(e, &all, group, i);
}

/* Pressure of the image: the column goes on. */
static double pressure(const sph_evaluation *e, const mirrors *all, const sph_ghost *ghost)
{
  const sph_view *parent = &e->view[ghost->group];
  const double rho = parent->rho[ghost->parent];
  double x[3], p = parent->p[ghost->parent];
  take(e->sim->dim, parent->x, ghost->parent, x);
  for (int k = 0; k < ghost->planes; k++) {
    const mirror *m = &all->of[ghost->in[k].group][ghost->in[k].plane];
    double d = 0;
    for (int c = 0; c < 3; c++) d += (x[c] - m->point[c]) * m->normal[c];
    p -= rho * 2 * d * dot(m->force, m->normal);
    reflect(m->normal, m->point, x);
  }
  return p;
}

static void fill(const sph_evaluation *e, const mirrors *all, const sph_group *group, long i)
{
  const sph_ghost *ghost = &group->ghost[i];
  const sph_group *fluid = e->sim->group[ghost->group];
  const sph_view *parent = &e->view[ghost->group], *own = &e->view[group->index];
  const long j = ghost->parent;
  const int eos = e->part->eos; /* else there is no pressure */
  const double p = eos ? pressure(e, all, ghost) : 0, before = eos ? parent->p[j] : 0;
  const double c = eos ? parent->c[j] : 0, rho = parent->rho[j];
  own->p[i] = p;
  own->c[i] = c;
  own->rho[i] = rho;
  if (eos && !fluid->eos.thermal && c > 0) own->rho[i] += (p - before) / (c * c);
  own->m[i] = parent->m[j] * (own->rho[i] / rho);
  own->u[i] = parent->u ? parent->u[j] : 0;
}

enum { CHUNK = 256 };

/* Some images of a group: where each is so far, reflection by reflection, and its temperature. */
typedef struct chunk {
  const sph_evaluation *e;
  const mirrors *all;
  const sph_ghost *ghost;
  int n, status;
  double x[3][CHUNK], T[CHUNK];
} chunk;

/* What the surface of a mirror is given, at places on it; 1: a temperature, 0: a flux, or 0. */
static int given(const sph_boundary *b, double t, long n, double x[3][CHUNK], double value[CHUNK])
{
  const double *const at[3] = {x[0], x[1], x[2]};
  const int isothermal = b->temperature_at || b->temperature > 0;
  sph_surface *surface = b->temperature_at ? b->temperature_at : b->heat_flux_at;
  for (long i = 0; i < n; i++) value[i] = isothermal ? b->temperature : b->heat_flux;
  if (surface) surface(b->ctx, t, n, at, value);
  return isothermal;
}

/* Reflection k of those images whose it is at mirror m. */
static void reflect_heat(chunk *c, const sph_group *m, int k)
{
  double foot[3][CHUNK], distance[CHUNK], value[CHUNK];
  int of[CHUNK], n = 0;
  for (int i = 0; i < c->n; i++) {
    if (k >= c->ghost[i].planes || c->ghost[i].in[k].group != m->index) continue;
    const mirror *plane = &c->all->of[m->index][c->ghost[i].in[k].plane];
    double d = 0;
    for (int a = 0; a < 3; a++) d += (c->x[a][i] - plane->point[a]) * plane->normal[a];
    for (int a = 0; a < 3; a++) {
      foot[a][n] = c->x[a][i] - d * plane->normal[a];
      c->x[a][i] -= 2 * d * plane->normal[a];
    }
    distance[n] = d;
    of[n++] = i;
  }
  if (!n) return;
  const int isothermal = given(&m->boundary, c->e->t, n, foot, value);
  for (int j = 0; j < n && !c->status; j++) {
    const double at[3] = {foot[0][j], foot[1][j], foot[2][j]};
    c->status = sph_sim_walls_surface(c->e, m, !isothermal, value[j], at);
  }
  for (int j = 0; j < n; j++) {
    double *T = &c->T[of[j]];
    const double kappa = c->e->sim->group[c->ghost[of[j]].group]->conductivity;
    if (isothermal)
      *T = 2 * value[j] - *T;
    else if (kappa > 0)
      *T += 2 * distance[j] * value[j] / kappa;
  }
}

static void warm(chunk *c, double *T)
{
  for (int i = 0; i < c->n; i++) {
    const sph_view *parent = &c->e->view[c->ghost[i].group];
    double x[3];
    take(c->e->sim->dim, parent->x, c->ghost[i].parent, x);
    for (int a = 0; a < 3; a++) c->x[a][i] = x[a];
    c->T[i] = parent->T ? parent->T[c->ghost[i].parent] : 0;
  }
  for (int k = 0; k < 3; k++)
    for (int g = 0; g < c->e->sim->groups; g++)
      if (is_mirror(c->e->sim->group[g])) reflect_heat(c, c->e->sim->group[g], k);
  memcpy(T, c->T, (size_t)c->n * sizeof *T);
}

/* Functions are the user's, and called by one thread. */
static int calls(const sph_sim *sim)
{
  int any = 0;
  for (int g = 0; g < sim->groups; g++)
    any |= is_mirror(sim->group[g]) &&
           (sim->group[g]->boundary.temperature_at || sim->group[g]->boundary.heat_flux_at);
  return any;
}

static int warm_all(const sph_evaluation *e, const mirrors *all, const sph_group *group)
{
  double *T = e->view[group->index].T;
  int status = SPH_OK;
  const int alone = group->n <= PARALLEL_MIN || calls(e->sim);
#pragma omp parallel for num_threads(e->sim->threads) schedule(static) if (!alone)
  for (long i = 0; i < group->n; i += CHUNK) {
    chunk c = {.e = e, .all = all, .ghost = group->ghost + i};
    c.n = group->n - i < CHUNK ? (int)(group->n - i) : CHUNK;
    warm(&c, T + i);
    if (alone && !status) status = c.status; /* numbers were right from the start */
  }
  return status;
}

int sph_sim_mirror_fill(const sph_evaluation *e, int g)
{
  const sph_group *group = e->sim->group[g];
  mirrors all;
  stand_all(e, &all);
#pragma omp parallel for num_threads(e->sim->threads) schedule(static) if (group->n > PARALLEL_MIN)
  for (long i = 0; i < group->n; i++) fill(e, &all, group, i);
  return e->view[g].T ? warm_all(e, &all, group) : SPH_OK;
}

/* ---- between steps ---- */

/* Two planes face to face: the room between them, else INFINITY. */
static double room(const mirror *a, const mirror *b)
{
  double between[3];
  for (int d = 0; d < 3; d++) between[d] = b->point[d] - a->point[d];
  return dot(a->normal, b->normal) < -1 + 1e-9 ? dot(between, a->normal) : INFINITY;
}

static int apart(sph_sim *sim, int g, const mirror *m, int other)
{
  const sph_evaluation e = {.sim = sim, .t = sim->time};
  const double reach = sim->H + sim->skin;
  for (int k = 0; k < sim->group[other]->boundary.planes; k++) {
    const mirror facing = stand(&e, sim->group[other], k);
    const double distance = room(m, &facing);
    if (distance < reach)
      return sph_sim_fail(sim, SPH_ERR_STATE,
                          "t = %g s: mirrors %s and %s have moved to %g m from each other; right "
                          "is the support and the skin, %g m, or more",
                          sim->time, sim->group[other]->name, sim->group[g]->name, distance, reach);
  }
  return SPH_OK;
}

int sph_sim_mirror_apart(sph_sim *sim)
{
  const sph_evaluation e = {.sim = sim, .t = sim->time};
  int status = SPH_OK;
  for (int g = 0; g < sim->groups; g++) /* those that do not move were fit before the run */
    for (int k = 0; is_mirror(sim->group[g]) && k < sim->group[g]->boundary.planes; k++)
      for (int o = 0; o < g && !status; o++) {
        if (!is_mirror(sim->group[o])) continue;
        if (!sim->group[g]->boundary.motion && !sim->group[o]->boundary.motion) continue;
        const mirror m = stand(&e, sim->group[g], k);
        status = apart(sim, g, &m, o);
      }
  return status;
}

static int bounce(int dim, const mirror *m, const sph_view *view, long i)
{
  double x[3], v[3], d = 0;
  take(dim, view->x, i, x);
  for (int c = 0; c < 3; c++) d += (x[c] - m->point[c]) * m->normal[c];
  if (d >= 0) return 0;
  take(dim, view->v, i, v);
  reflect(m->normal, m->point, x);
  reflect(m->normal, m->v, v);
  give(dim, x, view->x, i);
  give(dim, v, view->v, i);
  return 1;
}

long sph_sim_mirror_bounce(sph_sim *sim)
{
  const sph_evaluation e = {.sim = sim, .t = sim->time};
  long bounced = 0;
  for (int g = 0; g < sim->groups; g++)
    for (int k = 0; is_mirror(sim->group[g]) && k < sim->group[g]->boundary.planes; k++) {
      const mirror m = stand(&e, sim->group[g], k);
      for (int f = 0; f < sim->groups; f++) {
        if (sim->group[f]->wall || sim->group[f]->eos.dust) continue;
        const sph_view view = sph_group_data_view(sim->group[f], sph_nvector_data(sim->y), NULL);
        for (long i = 0; i < view.n; i++) bounced += bounce(sim->dim, &m, &view, i);
      }
    }
  if (bounced) sph_sim_changed(sim);
  return bounced;
}
