/* term_set.h -- the terms of a simulation: what the fused loops need of them, and those that are
 * called: body terms and users' own. */
#ifndef SPH_TERM_SET_H
#define SPH_TERM_SET_H
#include "fluid_pair.h"
#include "sphode/field.h"
#include "sphode/term.h"

enum { SPH_CALLED_TERMS_MAX = 32, SPH_TERM_NAME_MAX = 64, SPH_TERM_READS_MAX = 256 };

/* Beside the bits of the fused loops, where terms are told apart: the uniform body force; drag,
 * which has a loop of its own, as have what move particles besides their velocity. */
enum {
  SPH_UNIFORM = 1 << 30,
  SPH_DRAG = 1 << 29,
  SPH_SHIFTING = 1 << 28,
  SPH_TRANSPORT = 1 << 27,
  SPH_SHIFTS = SPH_SHIFTING | SPH_TRANSPORT
};

/* What an implicit term of the user's own changes. */
enum sph_term_changes { SPH_CHANGES_VELOCITY = 1, SPH_CHANGES_ENERGY = 2, SPH_CHANGES_SCALAR = 4 };

/* A term with callbacks, and its strings. */
typedef struct sph_called_term {
  sph_term term;
  char name[SPH_TERM_NAME_MAX], reads[SPH_TERM_READS_MAX], adds[SPH_TERM_READS_MAX];
  sph_group_value *by_group; /* what term.by_group is, owned; the names behind it */
  int scalar;                /* its number among the scalars, or -1 */
  int part;                  /* enum sph_term_part_number */
  unsigned changes;          /* where it may be implicit: enum sph_term_changes */
} sph_called_term;

typedef struct sph_scalar_kept {
  char name[SPH_TERM_NAME_MAX], unit[SPH_TERM_NAME_MAX];
  double scale, initial;
  sph_field_info info; /* name and unit point into this struct */
} sph_scalar_kept;

typedef struct sph_term_set {
  unsigned bits; /* pair terms: SPH_CONTINUITY | ... */
  /* Of these and SPH_UNIFORM: those of the parts; the others are explicit. */
  unsigned implicit, fast;
  int parted, uniform; /* a part was set; there is a uniform body force */
  /* Which terms asked for which row: all must be the same. */
  unsigned form_c2, form_c1, form_phi;
  int summed, calibrate;             /* density is a sum over neighbours */
  double alpha, beta;                /* artificial viscosity */
  double signal_alpha, signal_beta;  /* the one with a signal velocity */
  double alpha_min;                  /* of a switch that varies alpha */
  double alpha_u;                    /* artificial conductivity */
  double delta;                      /* density diffusion */
  double epsilon;                    /* XSPH */
  double stress_alpha, stress_beta;  /* artificial stress */
  sph_term shift;                    /* shifting or transport-velocity: its numbers */
  double drag_K, drag_rate;          /* drag_K + drag_rate rho_dust [kg/m^3/s], [1/s] */
  sph_term phi;                      /* of form phi: its exponent, phi, ctx; name NULL: none */
  double g[3];                       /* sum of the uniform body forces [m/s^2] */
  int called, pairs, heats, scalars; /* pairs, heats: called terms with pair; heat sources */
  sph_called_term call[SPH_CALLED_TERMS_MAX];
  sph_scalar_kept scalar[SPH_SCALARS_MAX];
} sph_term_set;

/* Checks a term and takes it in (its ctx too: on failure it is let go of). */
int sph_term_set_add(sph_term_set *set, const sph_term *term, sph_error *error);
/* New parameters of a built-in term that is there (gravity: of all of them); its form stays. */
int sph_term_set_change(sph_term_set *set, const sph_term *term, sph_error *error);
/* The bits of the built-in pair terms of that name; 0: none. */
unsigned sph_term_set_bits(const char *name);
/* Do the terms fit together? */
int sph_term_set_check(const sph_term_set *set, sph_error *error);
void sph_term_set_free(sph_term_set *set);
/* Energy per mass of all body forces that have a potential [J/kg]. */
double sph_term_set_potential(const sph_term_set *set, const double x[3]);
/* Number of the scalar of that name, or -1. */
int sph_term_set_scalar(const sph_term_set *set, const char *name);
/* Number of the scalar alpha of a switch, or -1; the alpha that a switch goes up to. */
int sph_term_set_alpha(const sph_term_set *set);
double sph_term_set_alpha_max(const sph_term_set *set);

#endif
