#include "term_set.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "memory.h"
#include "term_part.h"
#include "term_scalar_diffusion.h"

static int not_below_zero(const char *term, const char *name, double value, sph_error *error)
{
  if (isfinite(value) && value >= 0) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: %s = %g; right is a finite number >= 0",
                       term, name, value);
}

/* A second term of the same kind would silently replace the first. */
static int claim(sph_term_set *set, unsigned bit, const char *name, sph_error *error)
{
  if (set->bits & bit) return sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: added twice", name);
  set->bits |= bit;
  return SPH_OK;
}

static int add_form(sph_term_set *set, unsigned bit, const sph_term *term, const char *other,
                    sph_error *error)
{
  if (!term->form || !strcmp(term->form, "c2"))
    set->form_c2 |= bit;
  else if (!strcmp(term->form, other))
    set->form_c1 |= bit;
  else if (!strcmp(term->form, "phi"))
    set->form_phi |= bit;
  else
    return sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: form \"%s\"; known: c2, %s, phi",
                         term->name, term->form, other);
  return claim(set, bit, term->name, error);
}

/* How its gradients are corrected; mean 0: that is not known of this term. */
static int add_correction(sph_term_set *set, const sph_term *term, unsigned one_sided,
                          unsigned mean, sph_error *error)
{
  const char *correction = term->correction ? term->correction : "none";
  if (!strcmp(correction, "one-sided"))
    set->bits |= one_sided;
  else if (mean && !strcmp(correction, "mean"))
    set->bits |= mean;
  else if (strcmp(correction, "none") != 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term %s: correction \"%.60s\"; known: none, one-sided%s", term->name,
                         correction, mean ? ", mean" : "");
  return SPH_OK;
}

static int is_finite(const sph_term *term, const char *name, double value, sph_error *error)
{
  if (isfinite(value)) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: %s = %g is not finite", term->name, name,
                       value);
}

static int add_continuity(sph_term_set *set, const sph_term *term, sph_error *error)
{
  int status = is_finite(term, "exponent", term->exponent, error);
  if (!status) status = add_form(set, SPH_CONTINUITY, term, "c1", error);
  if (!status) status = add_correction(set, term, SPH_CONTINUITY_CORRECTED, 0, error);
  if (!status && set->summed)
    status = sph_error_set(error, SPH_ERR_ARGUMENT, "term continuity: density is summed already");
  if (!status && set->form_phi & SPH_CONTINUITY) {
    set->phi = *term;
    set->phi.name = "continuity";
    set->phi.form = "phi";
  }
  return status;
}

/* Its pressure force is that of the row C1, S. */
static int add_summation(sph_term_set *set, const sph_term *term, sph_error *error)
{
  if (set->summed || (set->bits & SPH_CONTINUITY))
    return sph_error_set(error, SPH_ERR_ARGUMENT, "term summation: density is already that of %s",
                         set->summed ? "summation" : "continuity");
  set->summed = 1;
  set->calibrate = term->calibrate != 0;
  set->form_c1 |= SPH_CONTINUITY;
  return SPH_OK;
}

static int add_conductivity(sph_term_set *set, const sph_term *term, sph_error *error)
{
  int status = not_below_zero(term->name, "alpha", term->alpha, error);
  if (!status) status = claim(set, SPH_CONDUCTIVITY, term->name, error);
  set->alpha_u = term->alpha;
  return status;
}

static int add_laminar(sph_term_set *set, const sph_term *term, sph_error *error)
{
  const char *form = term->form ? term->form : "morris";
  unsigned bit = !strcmp(form, "morris") ? SPH_MORRIS : !strcmp(form, "mcg") ? SPH_MCG : 0;
  if (!bit)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term viscosity-laminar: form \"%s\"; known: morris, mcg", form);
  if (set->bits & (SPH_MORRIS | SPH_MCG))
    return sph_error_set(error, SPH_ERR_ARGUMENT, "term viscosity-laminar: added twice");
  int status = claim(set, bit, term->name, error);
  return status ? status
                : add_correction(set, term, SPH_LAMINAR_ONE_SIDED, SPH_LAMINAR_MEAN, error);
}

static int add_xsph(sph_term_set *set, const sph_term *term, sph_error *error)
{
  if (!(term->epsilon >= 0 && term->epsilon <= 1))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term xsph: epsilon = %g; right is 0 to 1, usually up to 0.5",
                         term->epsilon);
  set->epsilon = term->epsilon;
  return claim(set, SPH_XSPH, term->name, error);
}

static int add_stress(sph_term_set *set, const sph_term *term, sph_error *error)
{
  int status = not_below_zero(term->name, "alpha", term->alpha, error);
  if (!status) status = not_below_zero(term->name, "beta", term->beta, error);
  if (!status) status = claim(set, SPH_STRESS, term->name, error);
  set->stress_alpha = term->alpha;
  set->stress_beta = term->beta;
  return status;
}

static int claim_shift(sph_term_set *set, unsigned bit, const sph_term *term, sph_error *error)
{
  if (set->bits & SPH_SHIFTS & ~bit)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term %s: particles are moved by %s already; right is one of them",
                         term->name, set->bits & SPH_SHIFTING ? "shifting" : "transport-velocity");
  set->shift = *term;
  set->shift.name = set->shift.form = NULL;
  return claim(set, bit, term->name, error);
}

static int add_shifting(sph_term_set *set, const sph_term *term, sph_error *error)
{
  const char *form = term->form ? term->form : "delta-plus";
  const int fick = !strcmp(form, "fick");
  if (!fick && strcmp(form, "delta-plus"))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term shifting: form \"%.60s\"; known: delta-plus, fick", form);
  if (!(term->speed > 0 && isfinite(term->speed)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term shifting: speed = %g m/s; right is > 0 and finite", term->speed);
  int status = not_below_zero(term->name, "strength", term->strength, error);
  if (!status) status = not_below_zero(term->name, "crowding", term->crowding, error);
  if (!status && term->steps < 0)
    status = sph_error_set(error, SPH_ERR_ARGUMENT, "term shifting: steps = %ld; right is >= 0",
                           term->steps);
  if (!status) status = claim_shift(set, SPH_SHIFTING, term, error);
  if (fick) set->shift.crowding = 0;
  return status;
}

static int add_transport(sph_term_set *set, const sph_term *term, sph_error *error)
{
  int status = not_below_zero(term->name, "background", term->background, error);
  if (!status) status = not_below_zero(term->name, "time", term->time, error);
  if (!status) status = claim_shift(set, SPH_TRANSPORT, term, error);
  set->shift.steps = 0;
  return status;
}

static int add_pressure(sph_term_set *set, const sph_term *term, sph_error *error)
{
  int status = add_form(set, SPH_PRESSURE_FORCE, term, "s", error);
  return status ? status
                : add_correction(set, term, SPH_PRESSURE_ONE_SIDED, SPH_PRESSURE_MEAN, error);
}

static int add_conduction(sph_term_set *set, const sph_term *term, sph_error *error)
{
  return claim(set, SPH_CONDUCTION, term->name, error);
}

static int add_delta(sph_term_set *set, const sph_term *term, sph_error *error)
{
  unsigned bit = 0;
  if (term->form && !strcmp(term->form, "molteni")) bit = SPH_MOLTENI;
  if (term->form && !strcmp(term->form, "antuono")) bit = SPH_ANTUONO;
  if (term->form && !strcmp(term->form, "fourtakas")) bit = SPH_FOURTAKAS;
  if (!bit)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term delta: model \"%s\"; known: molteni, antuono, fourtakas",
                         term->form ? term->form : "");
  int status = not_below_zero(term->name, "delta", term->delta, error);
  if (!status && (set->bits & SPH_DIFFUSION))
    status = sph_error_set(error, SPH_ERR_ARGUMENT, "term delta: added twice");
  set->bits |= bit;
  set->delta = term->delta;
  return status;
}

static int add_drag(sph_term_set *set, const sph_term *term, sph_error *error)
{
  const char *form = term->form ? term->form : "K";
  int timed = !strcmp(form, "time");
  if (!timed && strcmp(form, "K"))
    return sph_error_set(error, SPH_ERR_ARGUMENT, "term drag: form \"%s\"; known: K, time", form);
  if (timed && !(term->drag > 0 && isfinite(term->drag) && isfinite(1 / term->drag)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term drag: stopping time = %g s; right is > 0 and finite", term->drag);
  int status = timed ? SPH_OK : not_below_zero(term->name, "K", term->drag, error);
  if (!status) status = claim(set, SPH_DRAG, term->name, error);
  set->drag_K = timed ? 0 : term->drag;
  set->drag_rate = timed ? 1 / term->drag : 0;
  return status;
}

static int add_gravity(sph_term_set *set, const sph_term *term, sph_error *error)
{
  for (int d = 0; d < 3; d++) {
    if (!isfinite(term->g[d]))
      return sph_error_set(error, SPH_ERR_ARGUMENT, "term gravity: g[%d] = %g is not finite", d,
                           term->g[d]);
    set->g[d] += term->g[d];
  }
  set->uniform = 1;
  return SPH_OK;
}

int sph_term_set_scalar(const sph_term_set *set, const char *name)
{
  for (int k = 0; name && k < set->scalars; k++)
    if (!strcmp(set->scalar[k].name, name)) return k;
  return -1;
}

static int check_scalar(const sph_term_set *set, const sph_term *term, sph_error *error)
{
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  const sph_scalar *scalar = &term->scalar;
  size_t n = strlen(scalar->name);
  if (n == 0 || n >= SPH_TERM_NAME_MAX || strspn(scalar->name, letters) != n ||
      scalar->name[0] < 'a' || scalar->name[0] > 'z') /* data sets of snapshots: a capital */
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term %s: scalar \"%.80s\"; right is 1 to %d of A-Z a-z 0-9 _, the first "
                         "of a-z",
                         term->name, scalar->name, SPH_TERM_NAME_MAX - 1);
  if (scalar->unit && (strlen(scalar->unit) >= SPH_TERM_NAME_MAX ||
                       strcspn(scalar->unit, ",;\"[]\n\r\t") != strlen(scalar->unit)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term %s: scalar %s: unit \"%.80s\"; right is a text like kg/m^3, without "
                         ", ; \" [ ] and line ends",
                         term->name, scalar->name, scalar->unit);
  if (sph_field_find(scalar->name) >= 0 || sph_term_set_scalar(set, scalar->name) >= 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term %s: there is a field %s already; choose another name", term->name,
                         scalar->name);
  if (!(scalar->scale > 0 && scalar->scale < INFINITY) || !isfinite(scalar->initial))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term %s: scalar %s: scale = %g, initial = %g; right is finite and scale "
                         "> 0",
                         term->name, scalar->name, scalar->scale, scalar->initial);
  if (set->scalars == SPH_SCALARS_MAX)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: more than %d scalars", term->name,
                         SPH_SCALARS_MAX);
  return SPH_OK;
}

static int keep_scalar(sph_term_set *set, const sph_scalar *scalar)
{
  sph_scalar_kept *kept = &set->scalar[set->scalars];
  snprintf(kept->name, sizeof kept->name, "%s", scalar->name);
  snprintf(kept->unit, sizeof kept->unit, "%s", scalar->unit ? scalar->unit : "1");
  kept->scale = scalar->scale;
  kept->initial = scalar->initial;
  kept->info = (sph_field_info){kept->name, kept->name, kept->unit, 0, 1, 1};
  return set->scalars++;
}

/* ---- artificial viscosity ---- */

int sph_term_set_alpha(const sph_term_set *set)
{
  const unsigned varied = SPH_MORRIS_MONAGHAN | SPH_CULLEN_DEHNEN;
  return set->bits & varied ? sph_term_set_scalar(set, "alpha") : -1;
}

double sph_term_set_alpha_max(const sph_term_set *set)
{
  return set->bits & SPH_SIGNAL ? set->signal_alpha : set->alpha;
}

static int read_switches(const sph_term *term, unsigned *bits, sph_error *error)
{
  static const struct {
    const char *name;
    unsigned bit;
  } known[] = {{"none", 0},
               {"balsara", SPH_BALSARA},
               {"morris-monaghan", SPH_MORRIS_MONAGHAN},
               {"cullen-dehnen", SPH_CULLEN_DEHNEN}};
  enum { KNOWN = sizeof known / sizeof *known };
  const char *at = term->switches ? term->switches : "";
  for (size_t n; *(at += strspn(at, " ,")); at += n) {
    int k = 0;
    n = strcspn(at, " ,");
    while (k < KNOWN && (strlen(known[k].name) != n || strncmp(at, known[k].name, n) != 0)) k++;
    if (k == KNOWN)
      return sph_error_set(error, SPH_ERR_ARGUMENT,
                           "term %s: switches \"%.60s\"; known: none, balsara, morris-monaghan, "
                           "cullen-dehnen",
                           term->name, at);
    *bits |= known[k].bit;
  }
  return SPH_OK;
}

/* Its alpha, where a switch varies it, is a scalar that every particle carries. */
static int add_switches(sph_term_set *set, const sph_term *term, sph_error *error)
{
  const unsigned varied = SPH_MORRIS_MONAGHAN | SPH_CULLEN_DEHNEN;
  unsigned bits = 0;
  int status = read_switches(term, &bits, error);
  if (status) return status;
  if ((bits & varied) == varied)
    return sph_error_set(
        error, SPH_ERR_ARGUMENT,
        "term %s: switches morris-monaghan and cullen-dehnen: right is one of them", term->name);
  set->bits |= bits;
  if (!(bits & varied)) return SPH_OK;
  if (!(term->alpha > 0))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term %s: alpha = %g, up to which its switch goes; right is > 0",
                         term->name, term->alpha);
  sph_term alpha = *term;
  alpha.scalar = (sph_scalar){"alpha", "1", term->alpha, term->alpha_min, 0};
  set->alpha_min = term->alpha_min;
  status = check_scalar(set, &alpha, error);
  if (!status) keep_scalar(set, &alpha.scalar);
  return status;
}

/* Of a term that is there with switches, alpha and beta may change; these stay. */
static int check_viscosity(const sph_term_set *set, const sph_term *term, sph_error *error)
{
  const double least = sph_term_set_alpha(set) < 0 ? term->alpha_min : set->alpha_min;
  int status = not_below_zero(term->name, "alpha", term->alpha, error);
  if (!status) status = not_below_zero(term->name, "beta", term->beta, error);
  if (!status) status = not_below_zero(term->name, "alpha_min", least, error);
  if (!status && sph_term_set_alpha(set) >= 0 && !(term->alpha > 0))
    status = sph_error_set(error, SPH_ERR_ARGUMENT,
                           "term %s: alpha = %g, up to which its switch goes; right is > 0",
                           term->name, term->alpha);
  if (!status && (term->switches || sph_term_set_alpha(set) >= 0) && least > term->alpha)
    status =
        sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: alpha_min = %g; right is up to alpha = %g",
                      term->name, least, term->alpha);
  return status;
}

static int add_viscosity(sph_term_set *set, const sph_term *term, sph_error *error)
{
  int status = check_viscosity(set, term, error);
  if (!status) status = claim(set, SPH_ARTIFICIAL, term->name, error);
  set->alpha = term->alpha;
  set->beta = term->beta;
  return status ? status : add_switches(set, term, error);
}

static int add_signal(sph_term_set *set, const sph_term *term, sph_error *error)
{
  int status = check_viscosity(set, term, error);
  if (!status) status = claim(set, SPH_SIGNAL, term->name, error);
  set->signal_alpha = term->alpha;
  set->signal_beta = term->beta;
  return status ? status : add_switches(set, term, error);
}

static int check_called(const sph_term_set *set, const sph_term *term, sph_error *error)
{
  if (!strcmp(term->name, "heat-source") && !term->body)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "term heat-source: no power function (NULL)");
  if (!term->body && !term->pair)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term \"%s\": not a built-in one and without a body or pair function",
                         term->name);
  if (is_finite(term, "omega", term->omega, error)) return SPH_ERR_ARGUMENT;
  if ((term->reads && strlen(term->reads) >= SPH_TERM_READS_MAX) ||
      (term->adds && strlen(term->adds) >= SPH_TERM_READS_MAX))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term %s: reads or adds of more than %d characters", term->name,
                         SPH_TERM_READS_MAX - 1);
  if (set->called == SPH_CALLED_TERMS_MAX)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: more than %d terms with functions",
                         term->name, SPH_CALLED_TERMS_MAX);
  int status = sph_term_part_changes(term, NULL, error);
  return !status && term->scalar.name ? check_scalar(set, term, error) : status;
}

/* D of a scalar, and the numbers of its groups. */
static int check_groups(const sph_term *term, sph_error *error)
{
  int status = not_below_zero(term->name, "diffusivity", term->diffusivity, error);
  for (int k = 0; !status && k < term->by_groups; k++) {
    const sph_group_value *one = &term->by_group[k];
    if (!one->group)
      status =
          sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: a value of no group (NULL)", term->name);
    else if (!isfinite(one->value))
      status = sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: group %s: %g is not finite",
                             term->name, one->group, one->value);
  }
  return status;
}

/* A copy, with the names behind it. */
static int keep_groups(const sph_term *term, sph_group_value **kept, sph_error *error)
{
  size_t letters = 0;
  if (term->by_groups <= 0) return SPH_OK;
  const size_t n = (size_t)term->by_groups;
  for (size_t k = 0; k < n; k++) letters += strlen(term->by_group[k].group) + 1;
  *kept = sph_memory_new(n * sizeof **kept + letters, 1, "the groups of a scalar", error);
  if (!*kept) return SPH_ERR_MEMORY;
  char *text = (char *)(*kept + n);
  for (size_t k = 0; k < n; k++) {
    const size_t length = strlen(term->by_group[k].group) + 1;
    (*kept)[k] =
        (sph_group_value){memcpy(text, term->by_group[k].group, length), term->by_group[k].value};
    text += length;
  }
  return SPH_OK;
}

static int add_called(sph_term_set *set, const sph_term *term, sph_error *error)
{
  sph_group_value *by_group = NULL;
  int status = check_called(set, term, error);
  if (!status) status = check_groups(term, error);
  if (!status) status = keep_groups(term, &by_group, error);
  if (status) return status;
  sph_called_term *kept = &set->call[set->called++];
  kept->by_group = by_group;
  kept->term = *term;
  kept->term.by_group = by_group;
  sph_term_scalar_diffusion_settle(&kept->term);
  snprintf(kept->name, sizeof kept->name, "%s", term->name);
  snprintf(kept->reads, sizeof kept->reads, "%s", term->reads ? term->reads : "");
  kept->term.name = kept->name;
  kept->term.reads = term->reads ? kept->reads : NULL;
  snprintf(kept->adds, sizeof kept->adds, "%s", term->adds ? term->adds : "");
  kept->term.adds = term->adds ? kept->adds : NULL;
  kept->term.form = kept->term.correction = kept->term.switches = NULL;
  sph_term_part_changes(term, &kept->changes, error);
  kept->term.implicit = NULL; /* as read in changes */
  kept->scalar = term->scalar.name ? keep_scalar(set, &term->scalar) : -1;
  if (kept->scalar >= 0) {
    kept->term.scalar.name = set->scalar[kept->scalar].name;
    kept->term.scalar.unit = set->scalar[kept->scalar].unit;
  }
  set->pairs += kept->term.pair != NULL;
  set->heats += !strcmp(term->name, "heat-source");
  return SPH_OK;
}

static int add(sph_term_set *set, const sph_term *term, sph_error *error)
{
  static const struct {
    const char *name;
    int (*add)(sph_term_set *set, const sph_term *term, sph_error *error);
  } built_in[] = {
      {"continuity", add_continuity},
      {"summation", add_summation},
      {"pressure", add_pressure},
      {"viscosity-artificial", add_viscosity},
      {"viscosity-signal", add_signal},
      {"viscosity-laminar", add_laminar},
      {"conductivity-artificial", add_conductivity},
      {"conduction", add_conduction},
      {"xsph", add_xsph},
      {"delta", add_delta},
      {"drag", add_drag},
      {"gravity", add_gravity},
      {"shifting", add_shifting},
      {"transport-velocity", add_transport},
      {"stress-artificial", add_stress},
  };
  static const char *const corrected[] = {"continuity", "pressure", "viscosity-laminar"};
  int can = 0;
  if (!term->name || !*term->name)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "a term without a name");
  for (int k = 0; k < 3; k++) can |= !strcmp(term->name, corrected[k]);
  if (term->correction && strcmp(term->correction, "none") != 0 &&
      (!can || term->body || term->pair))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term %s: correction \"%.60s\"; only continuity, pressure and "
                         "viscosity-laminar have one",
                         term->name, term->correction);
  for (size_t k = 0; !term->body && !term->pair && k < sizeof built_in / sizeof *built_in; k++)
    if (!strcmp(term->name, built_in[k].name)) return built_in[k].add(set, term, error);
  return add_called(set, term, error);
}

int sph_term_set_add(sph_term_set *set, const sph_term *term, sph_error *error)
{
  int called = set->called, status = add(set, term, error);
  int kept = set->called > called || (!status && term->phi); /* phi reads ctx in every evaluation */
  if (!kept && term->free) term->free(term->ctx);
  return status;
}

/* Terms whose parameters may change while a simulation runs. */
static const struct {
  const char *name;
  unsigned bits;
} changeable[] = {
    {"viscosity-artificial", SPH_ARTIFICIAL},
    {"viscosity-signal", SPH_SIGNAL},
    {"conductivity-artificial", SPH_CONDUCTIVITY},
    {"xsph", SPH_XSPH},
    {"delta", SPH_DIFFUSION},
    {"drag", SPH_DRAG},
};

unsigned sph_term_set_bits(const char *name)
{
  for (size_t k = 0; name && k < sizeof changeable / sizeof *changeable; k++)
    if (!strcmp(name, changeable[k].name)) return changeable[k].bits;
  return 0;
}

static int change_harmonic(sph_term_set *set, const sph_term *term, sph_error *error)
{
  int status = is_finite(term, "omega", term->omega, error), found = 0;
  for (int k = 0; !status && k < set->called; k++)
    if (set->call[k].term.body == term->body) {
      set->call[k].term.omega = term->omega;
      found = 1;
    }
  if (status || found) return status;
  return sph_error_set(error, SPH_ERR_ARGUMENT, "term harmonic: the simulation has none");
}

/* As if it were added anew. */
static int change_pair(sph_term_set *set, const sph_term *term, sph_error *error)
{
  unsigned bits = sph_term_set_bits(term->name), was = set->bits;
  if (!(was & bits))
    return sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: the simulation has none", term->name);
  set->bits &= ~bits;
  sph_term same = *term; /* its switches stay, too */
  same.switches = NULL;
  int status = add(set, &same, error);
  if (!status && set->bits != was)
    status =
        sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: form \"%s\" is another one than before",
                      term->name, term->form);
  return status;
}

int sph_term_set_change(sph_term_set *set, const sph_term *term, sph_error *error)
{
  const char *name = term->name ? term->name : "";
  int own = term->pair || (term->body && strcmp(name, "harmonic") != 0);
  if (!own && !strcmp(name, "harmonic")) return change_harmonic(set, term, error);
  if (!own && !strcmp(name, "gravity")) {
    for (int d = 0; d < 3; d++) set->g[d] = 0;
    return add_gravity(set, term, error);
  }
  if (!own && sph_term_set_bits(name)) return change_pair(set, term, error);
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "term \"%.60s\" cannot change; gravity, harmonic, viscosity-artificial, "
                       "viscosity-signal, conductivity-artificial, xsph, delta, drag can",
                       name);
}

/* Continuity and pressure force are partners in their corrections, too. */
static int check_corrections(const sph_term_set *set, sph_error *error)
{
  const unsigned bits = set->bits;
  const int pressure = (bits & SPH_PRESSURE_FORCE) != 0, mean = (bits & SPH_PRESSURE_MEAN) != 0;
  if (set->summed && mean)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term pressure: correction mean belongs to continuity of correction "
                         "one-sided; beside summation right is none or one-sided");
  if (pressure && !(bits & SPH_PRESSURE_ONE_SIDED) && (bits & SPH_CONTINUITY) &&
      mean != ((bits & SPH_CONTINUITY_CORRECTED) != 0))
    return sph_error_set(
        error, SPH_ERR_ARGUMENT,
        "continuity of correction %s and pressure of correction %s do not conserve "
        "energy: use one-sided with mean, none with none (pressure of correction "
        "one-sided conserves none, and goes with both)",
        bits & SPH_CONTINUITY_CORRECTED ? "one-sided" : "none", mean ? "mean" : "none");
  return SPH_OK;
}

int sph_term_set_check(const sph_term_set *set, sph_error *error)
{
  int forms = (set->form_c2 != 0) + (set->form_c1 != 0) + (set->form_phi != 0);
  if (forms > 1)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "continuity and pressure of different rows do not conserve energy: "
                         "use c2 with c2, c1 or summation with s, phi with phi");
  if (set->form_phi == SPH_PRESSURE_FORCE)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term pressure: form phi takes phi from continuity of form phi");
  if ((set->bits & SPH_SWITCHES) && (set->bits & SPH_ARTIFICIAL) && (set->bits & SPH_SIGNAL))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "viscosity-artificial and viscosity-signal, one of them with a switch: "
                         "leave the other one out");
  if ((set->bits & SPH_SWITCHES) && (set->implicit & set->bits & SPH_ARTIFICIAL))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "viscosity-artificial with a switch cannot be implicit");
  if (set->summed && (set->bits & SPH_DIFFUSION) && set->delta > 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term delta diffuses a density that is integrated; summation has none: "
                         "leave one of them out");
  return check_corrections(set, error);
}

void sph_term_set_free(sph_term_set *set)
{
  for (int k = 0; k < set->called; k++) {
    if (set->call[k].term.free) set->call[k].term.free(set->call[k].term.ctx);
    sph_memory_free(set->call[k].by_group);
  }
  if (set->phi.phi && set->phi.free) set->phi.free(set->phi.ctx);
  set->phi = (sph_term){0};
  set->called = 0;
}

double sph_term_set_potential(const sph_term_set *set, const double x[3])
{
  double potential = 0;
  for (int d = 0; d < 3; d++) potential -= set->g[d] * x[d];
  for (int k = 0; k < set->called; k++) {
    const sph_term *term = &set->call[k].term;
    if (term->potential) potential += term->potential(term, x);
  }
  return potential;
}
