/* The right-hand side dy/dt = f(t, y), phase by phase; each does only what the part of f that is
 * evaluated needs (sim_parts.c).  f depends on (t, y) and on the sort order of the last list build
 * only; nothing else is kept from one call to the next. */
#include "sim_rhs.h"

#include "clock.h"
#include "comm.h"

void sph_sim_rhs_views(sph_evaluation *e, N_Vector y, N_Vector ydot)
{
  for (int g = 0; g < e->sim->groups; g++)
    e->view[g] = sph_group_data_view(e->sim->group[g], sph_nvector_data(y),
                                     ydot ? sph_nvector_data(ydot) : NULL);
}

static int phases(sph_evaluation *e)
{
  int status = sph_sim_walls_move(e);
  if (!status && e->part->lists) status = sph_sim_lists_update(e); /* neighbors */
  if (!status) status = sph_comm_exchange(SPH_COMM_STATE);
  if (!status) status = sph_sim_density(e); /* density */
  if (!status) status = sph_comm_exchange(SPH_COMM_DENSITY);
  if (!status) status = sph_sim_material_eos(e); /* eos */
  if (!status) status = sph_sim_bodies_add(e);   /* bodies */
  if (!status) status = sph_sim_walls_fill(e);   /* walls */
  if (!status) status = sph_comm_exchange(SPH_COMM_WALLS);
  if (!status) status = sph_sim_gradients(e); /* prepare */
  if (!status) status = sph_sim_switches(e);  /* switches */
  if (!status) status = sph_comm_exchange(SPH_COMM_GRADIENTS);
  if (!status) status = sph_sim_shift_add(e); /* shift */
  if (!status) status = sph_sim_drag_add(e);  /* drag */
  if (!status) status = sph_sim_pairs_add(e); /* pairs */
  if (!status) status = sph_sim_switches_rates(e);
  if (!status) status = sph_sim_admit(e); /* admit */
  return status;
}

static int evaluate(sph_sim *sim, const sph_part *part, int still, double t, N_Vector y,
                    N_Vector ydot)
{
  double begin = sph_clock();
  sph_evaluation e = {.sim = sim, .t = t, .part = part, .still = still};
  sph_sim_rhs_views(&e, y, ydot);
  int status = phases(&e);
  sim->derived = 0; /* pressure etc. are those of y */
  sim->rhs_seconds += sph_clock() - begin;
  return status;
}

int sph_sim_rhs_part(sph_sim *sim, const sph_part *part, double t, N_Vector y, N_Vector ydot)
{
  return evaluate(sim, part, 0, t, y, ydot);
}

int sph_sim_rhs_vectors(sph_sim *sim, N_Vector y, N_Vector other)
{
  const long length = sim->layout.length;
  if (sph_nvector_holds(y, length) && sph_nvector_holds(other, length)) return SPH_OK;
  return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                      "a vector is none of this simulation; right are sph_sim_vector's and its "
                      "clones (N_VClone)");
}

int sph_sim_rhs_piece(int piece, double t, N_Vector y, N_Vector ydot, void *ctx)
{
  sph_sim *sim = ctx;
  int status = sph_sim_rhs_vectors(sim, y, ydot);
  return status ? status : sph_sim_rhs_part(sim, &sim->part[piece], t, y, ydot);
}

int sph_sim_rhs(double t, N_Vector y, N_Vector ydot, void *ctx)
{
  return sph_sim_rhs_piece(SPH_WHOLE, t, y, ydot, ctx);
}

int sph_sim_rhs_still(double t, N_Vector y, N_Vector ydot, void *ctx)
{
  sph_sim *sim = ctx;
  int status = sph_sim_rhs_vectors(sim, y, ydot);
  return status ? status : evaluate(sim, &sim->part[SPH_WHOLE], 1, t, y, ydot);
}

int sph_sim_rhs_explicit(double t, N_Vector y, N_Vector ydot, void *ctx)
{
  return sph_sim_rhs_piece(SPH_PIECE_EXPLICIT, t, y, ydot, ctx);
}

int sph_sim_rhs_implicit(double t, N_Vector y, N_Vector ydot, void *ctx)
{
  return sph_sim_rhs_piece(SPH_PIECE_IMPLICIT, t, y, ydot, ctx);
}

int sph_sim_rhs_fast(double t, N_Vector y, N_Vector ydot, void *ctx)
{
  return sph_sim_rhs_piece(SPH_PIECE_FAST, t, y, ydot, ctx);
}

static int show(sph_sim *sim, double t, N_Vector y, int anew)
{
  sph_evaluation e = {.sim = sim, .t = t, .part = &sim->part[SPH_WHOLE]};
  sph_sim_rhs_views(&e, y, NULL);
  int status = sph_sim_walls_move(&e);
  if (!status && (anew || !sim->listed)) status = sph_sim_lists_update(&e);
  if (!status) status = sph_sim_density(&e);
  if (!status) status = sph_sim_material_eos(&e);
  if (!status) status = sph_sim_walls_fill(&e);
  return status;
}

int sph_sim_rhs_show(sph_sim *sim, double t, N_Vector y) { return show(sim, t, y, 0); }
int sph_sim_rhs_show_anew(sph_sim *sim, double t, N_Vector y) { return show(sim, t, y, 1); }
