/* snapshot.c -- GADGET's groups and datasets, and /VTKHDF as links to them.
 *
 * VTK wants one array a field, GADGET one a particle type; a link cannot join two.  So /VTKHDF is
 * the fluids (/PartType0), which people look at, and /Walls is the same thing for /PartType1;
 * another file, a kilobyte, shows it to ParaView as its own object, which can be hidden. */
#include "snapshot.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "h5.h"
#include "memory.h"
#include "sphode/field.h"
#include "sphode/kernel.h"
#include "table.h"
#include "units.h"
#include "versions.h"
#include "words.h"

static const char *const part_names[SPH_PARTS] = {"PartType0", "PartType1"};
static const char *const vtk_names[SPH_PARTS] = {"VTKHDF", "Walls"};
static const char *const part_kinds[SPH_PARTS] = {"fluid", "wall"};

static const char *const dataset_names[][2] = {
    {"position", "Coordinates"},
    {"velocity", "Velocities"},
    {"mass", "Masses"},
    {"density", "Density"},
    {"energy", "InternalEnergy"},
    {"pressure", "Pressure"},
    {"sound_speed", "SoundSpeed"},
    {"id", "ParticleIDs"},
    {"group", "Group"},
    {"smoothing_length", "SmoothingLength"},
};

const char *sph_snapshot_dataset(const char *field)
{
  for (size_t k = 0; k < sizeof dataset_names / sizeof *dataset_names; k++)
    if (!strcmp(field, dataset_names[k][0])) return dataset_names[k][1];
  return field; /* a new field is written under its own name */
}

const char *sph_snapshot_field(const char *dataset)
{
  for (size_t k = 0; k < sizeof dataset_names / sizeof *dataset_names; k++)
    if (!strcmp(dataset, dataset_names[k][1])) return dataset_names[k][0];
  return dataset;
}

typedef struct writer {
  sph_h5 h5;
  hid_t file;
  sph_sim *sim;
  int dim;
  int single;
  const char *fields; /* that are asked for; NULL: all */
  long n[SPH_PARTS];
  void *buffer; /* [3 * larger n] doubles */
} writer;

/* Group number *k or the next one of a part; NULL behind the last. */
static const sph_group *next_group(const writer *w, int part, int *k)
{
  const sph_group *group;
  for (; (group = sph_sim_group_get(w->sim, *k)); ++*k)
    if (!strcmp(sph_group_kind(group), part_kinds[part])) break;
  return group;
}

static void count_particles(writer *w)
{
  const sph_group *group;
  for (int part = 0; part < SPH_PARTS; part++)
    for (int k = 0; (group = next_group(w, part, &k)); k++) w->n[part] += sph_group_count(group);
}

/* A barotropic fluid has no u to integrate; its energy balance counts the elastic energy. */
static void elastic(const sph_group *group, double *to, long n)
{
  const sph_eos *eos = sph_group_eos(group);
  const double *rho = sph_group_read(group, "density", 0);
  for (long i = 0; i < n; i++)
    to[i] = eos && eos->elastic_energy && rho ? eos->elastic_energy(eos, rho[i]) : 0;
}

/* Into the box of direction d, where that is periodic: what looks at a snapshot knows no box. */
static void wrap(const writer *w, double *x, long n, int stride, int d)
{
  double origin, length;
  if (!sph_sim_periodic(w->sim, d, &origin, &length)) return;
  for (long i = 0; i < n; i++)
    x[i * stride + d] -= length * floor((x[i * stride + d] - origin) / length);
}

/* The field of all groups of a part into w->buffer, [n] or [n][3]; 0 where no group has it. */
static int gather(writer *w, int part, const sph_field_info *field)
{
  const sph_group *group;
  int stride = field->vector ? 3 : 1, components = field->vector ? w->dim : 1, found = 0;
  double *to = w->buffer;
  memset(to, 0, (size_t)w->n[part] * (size_t)stride * sizeof *to);
  for (int k = 0; (group = next_group(w, part, &k)); k++) {
    long n = sph_group_count(group);
    for (int d = 0; d < components; d++) {
      const double *from = sph_group_read(group, field->name, d);
      for (long i = 0; from && i < n; i++) to[i * stride + d] = from[i];
      if (from && !strcmp(field->name, "position")) wrap(w, to, n, stride, d);
      found |= from != NULL;
      if (!from && part == SPH_FLUIDS && !strcmp(field->name, "energy")) {
        elastic(group, to, n);
        found = 1;
      }
    }
    to += n * stride;
  }
  return found;
}

static void write_unit(writer *w, hid_t where, const char *dataset, const char *unit)
{
  hid_t set = w->h5.failed ? -1 : H5Dopen2(where, dataset, H5P_DEFAULT);
  if (set < 0) return;
  sph_h5_string(&w->h5, set, "unit", unit);
  H5Dclose(set);
}

static const char *unit_of(const writer *w, const sph_field_info *field)
{
  return strcmp(field->name, "mass") ? field->unit : sph_units_get(SPH_UNIT_MASS, w->dim);
}

static hid_t stored(const writer *w) { return w->single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE; }

static void write_numbers(writer *w, hid_t where, int part)
{
  const sph_group *group;
  double *h = w->buffer;
  hsize_t n = (hsize_t)w->n[part];
  for (long i = 0; i < w->n[part]; i++) h[i] = sph_sim_h(w->sim);
  sph_h5_array(&w->h5, where, "SmoothingLength", stored(w), H5T_NATIVE_DOUBLE, n, 0, h);
  write_unit(w, where, "SmoothingLength", "m");
  long *id = w->buffer;
  for (int k = 0; (group = next_group(w, part, &k)); k++)
    for (long i = 0; i < sph_group_count(group); i++) *id++ = sph_group_id(group, i);
  sph_h5_array(&w->h5, where, "ParticleIDs", H5T_STD_I64LE, H5T_NATIVE_LONG, n, 0, w->buffer);
  int *index = w->buffer;
  for (int k = 0; (group = next_group(w, part, &k)); k++)
    for (long i = 0; i < sph_group_count(group); i++) *index++ = k;
  sph_h5_array(&w->h5, where, "Group", H5T_STD_I32LE, H5T_NATIVE_INT, n, 0, w->buffer);
}

int sph_snapshot_holds(const char *fields, const char *field)
{
  static const char *const always[] = {"position", "mass", "density"};
  for (int k = 0; k < 3; k++)
    if (!strcmp(field, always[k])) return 1;
  return !fields || sph_table_listed(fields, field);
}

static void write_part(writer *w, int part)
{
  int first = 0; /* the groups of a part have the same fields */
  const sph_group *group = next_group(w, part, &first);
  const sph_field_info *field;
  hid_t where = sph_h5_group(&w->h5, w->file, part_names[part]);
  for (int k = 0; (field = sph_group_field(group, k)); k++) {
    if (!field->saved || !sph_snapshot_holds(w->fields, field->name)) continue;
    if (!gather(w, part, field)) continue;
    const char *name = sph_snapshot_dataset(field->name);
    sph_h5_array(&w->h5, where, name, stored(w), H5T_NATIVE_DOUBLE, (hsize_t)w->n[part],
                 field->vector ? 3 : 0, w->buffer);
    write_unit(w, where, name, unit_of(w, field));
  }
  write_numbers(w, where, part);
  if (where >= 0) H5Gclose(where);
}

static void write_vtk_cells(writer *w, hid_t vtk, int part)
{
  hsize_t n = (hsize_t)w->n[part];
  long *place = w->buffer;
  for (long i = 0; i <= w->n[part]; i++) place[i] = i;
  sph_h5_array(&w->h5, vtk, "Connectivity", H5T_STD_I64LE, H5T_NATIVE_LONG, n, 0, place);
  sph_h5_array(&w->h5, vtk, "Offsets", H5T_STD_I64LE, H5T_NATIVE_LONG, n + 1, 0, place);
  memset(w->buffer, 1, (size_t)n); /* VTK_VERTEX */
  sph_h5_array(&w->h5, vtk, "Types", H5T_STD_U8LE, H5T_NATIVE_UCHAR, n, 0, w->buffer);
  static const char *const counts[] = {"NumberOfPoints", "NumberOfCells",
                                       "NumberOfConnectivityIds"};
  for (int k = 0; k < 3; k++)
    sph_h5_array(&w->h5, vtk, counts[k], H5T_STD_I64LE, H5T_NATIVE_LONG, 1, 0, &w->n[part]);
}

typedef struct linking {
  writer *w;
  hid_t data;
} linking;

/* "Density [kg per m^3]": what tools show is the name alone, and a link's name has no "/". */
static void vtk_name(hid_t part, const char *dataset, char name[256])
{
  char unit[64] = "";
  hid_t set = H5Dopen2(part, dataset, H5P_DEFAULT);
  if (set < 0 || sph_h5_read_string(set, "unit", unit, sizeof unit)) unit[0] = '\0';
  if (set >= 0) H5Dclose(set);
  int n = snprintf(name, 256, unit[0] ? "%.100s [" : "%.100s", dataset);
  for (const char *c = unit; *c && n < 240; c++)
    n += snprintf(name + n, 256 - (size_t)n, *c == '/' ? " per " : "%c", *c);
  if (unit[0]) snprintf(name + n, 256 - (size_t)n, "]");
}

static herr_t link_one(hid_t part, const char *dataset, const H5L_info_t *info, void *ctx)
{
  linking *l = ctx;
  char name[256];
  (void)info;
  vtk_name(part, dataset, name);
  if (strcmp(dataset, "Coordinates") != 0) sph_h5_link(&l->w->h5, part, dataset, l->data, name);
  return 0;
}

/* VTKHDF 1.0: what ParaView 5.11 reads; later ones do too. */
static void write_vtk(writer *w, int part)
{
  hid_t vtk = sph_h5_group(&w->h5, w->file, vtk_names[part]);
  hid_t data = sph_h5_group(&w->h5, vtk, "PointData");
  hid_t from = w->h5.failed ? -1 : H5Gopen2(w->file, part_names[part], H5P_DEFAULT);
  if (from >= 0) {
    sph_h5_integer(&w->h5, vtk, "Version", 2, (int[]){1, 0});
    sph_h5_string(&w->h5, vtk, "Type", "UnstructuredGrid");
    sph_h5_link(&w->h5, from, "Coordinates", vtk, "Points");
    H5Literate(from, H5_INDEX_NAME, H5_ITER_INC, NULL, link_one, &(linking){w, data});
    write_vtk_cells(w, vtk, part);
    H5Gclose(from);
  }
  if (data >= 0) H5Gclose(data);
  if (vtk >= 0) H5Gclose(vtk);
}

/* GADGET's box is [0, BoxSize]: here the largest coordinate in size. */
static double box_size(const writer *w)
{
  double size = sph_sim_dx(w->sim);
  const sph_group *group;
  for (int k = 0; (group = sph_sim_group_get(w->sim, k)); k++)
    for (int d = 0; d < w->dim; d++) {
      const double *x = sph_group_read(group, "position", d);
      for (long i = 0; x && i < sph_group_count(group); i++) size = fmax(size, fabs(x[i]));
    }
  return size;
}

static void write_header(writer *w)
{
  hid_t header = sph_h5_group(&w->h5, w->file, "Header");
  int count[6] = {(int)w->n[SPH_FLUIDS], (int)w->n[SPH_WALLS]};
  static const char *const zeros[] = {
      "Flag_Sfr",    "Flag_Cooling",  "Flag_StellarAge",
      "Flag_Metals", "Flag_Feedback", "Flag_Entropy_ICs",
  };
  static const struct {
    const char *name;
    double value;
  } cosmology[] = {{"Redshift", 0}, {"Omega0", 0}, {"OmegaLambda", 0}, {"HubbleParam", 1}};
  double time = sph_sim_time(w->sim), dx = sph_sim_dx(w->sim), box = box_size(w);
  sph_h5_integer(&w->h5, header, "NumPart_ThisFile", 6, count);
  sph_h5_integer(&w->h5, header, "NumPart_Total", 6, count);
  sph_h5_integer(&w->h5, header, "NumPart_Total_HighWord", 6, (int[6]){0});
  sph_h5_integer(&w->h5, header, "NumFilesPerSnapshot", 0, (int[]){1});
  sph_h5_integer(&w->h5, header, "Flag_DoublePrecision", 0, (int[]){!w->single});
  for (size_t k = 0; k < sizeof zeros / sizeof *zeros; k++)
    sph_h5_integer(&w->h5, header, zeros[k], 0, (int[]){0});
  sph_h5_real(&w->h5, header, "MassTable", 6, (double[6]){0});
  for (size_t k = 0; k < sizeof cosmology / sizeof *cosmology; k++)
    sph_h5_real(&w->h5, header, cosmology[k].name, 0, &cosmology[k].value);
  sph_h5_real(&w->h5, header, "Time", 0, &time);
  sph_h5_real(&w->h5, header, "BoxSize", 0, &box);
  sph_h5_real(&w->h5, header, "Spacing", 0, &dx);
  sph_h5_integer(&w->h5, header, "Dimension", 0, &w->dim);
  if (header >= 0) H5Gclose(header);
}

static void write_group(writer *w, hid_t groups, const sph_group *group, int index)
{
  const sph_eos *eos = sph_group_eos(group);
  int wall = !strcmp(sph_group_kind(group), "wall"), count = (int)sph_group_count(group);
  hid_t one = sph_h5_group(&w->h5, groups, sph_group_name(group));
  sph_h5_integer(&w->h5, one, "Index", 0, &index);
  sph_h5_integer(&w->h5, one, "PartType", 0, &wall);
  sph_h5_integer(&w->h5, one, "NumPart", 0, &count);
  sph_h5_string(&w->h5, one, "Kind", sph_group_kind(group));
  if (eos) {
    sph_h5_string(&w->h5, one, "EOS", eos->name ? eos->name : "");
    sph_h5_real(&w->h5, one, "EOS_rho0", 0, &eos->rho0);
    sph_h5_real(&w->h5, one, "EOS_c0", 0, &eos->c0);
    sph_h5_real(&w->h5, one, "EOS_gamma", 0, &eos->gamma);
    sph_h5_real(&w->h5, one, "EOS_p_background", 0, &eos->p_background);
    sph_h5_real(&w->h5, one, "EOS_p_inf", 0, &eos->p_inf);
    sph_h5_real(&w->h5, one, "EOS_q", 0, &eos->q);
    sph_h5_real(&w->h5, one, "EOS_slope", 0, &eos->slope);
    sph_h5_real(&w->h5, one, "EOS_grueneisen", 0, &eos->grueneisen);
    sph_h5_real(&w->h5, one, "EOS_c_v", 0, &eos->c_v);
  }
  if (one >= 0) H5Gclose(one);
}

static void write_groups(writer *w)
{
  const sph_group *group;
  hid_t groups = sph_h5_group(&w->h5, w->file, "Groups");
  for (int k = 0; (group = sph_sim_group_get(w->sim, k)); k++) write_group(w, groups, group, k);
  if (groups >= 0) H5Gclose(groups);
}

static void write_provenance(writer *w, const char *case_text, const char *command)
{
  sph_h5 *h5 = &w->h5;
  hid_t code = sph_h5_group(h5, w->file, "Code");
  sph_h5_string(h5, code, "Name", "sphode");
  sph_h5_string(h5, code, "Version", sph_version());
  sph_h5_string(h5, code, "Compiler", sph_versions_compiler());
  sph_h5_string(h5, code, "SUNDIALS", sph_versions_sundials());
  if (command) sph_h5_text(h5, code, "Command", command);
  if (code >= 0) H5Gclose(code);
  hid_t parameters = sph_h5_group(h5, w->file, "Parameters");
  double h = sph_sim_h(w->sim), dx = sph_sim_dx(w->sim);
  sph_h5_string(h5, parameters, "Kernel", sph_sim_kernel(w->sim));
  sph_h5_string(h5, parameters, "Integrator", sph_sim_integrator(w->sim));
  sph_h5_string(h5, parameters, "InstructionSet", sph_sim_isa(w->sim));
  sph_h5_real(h5, parameters, "h", 0, &h);
  sph_h5_real(h5, parameters, "dx", 0, &dx);
  int periodic[3] = {0};
  double origin[3] = {0}, length[3] = {0};
  for (int d = 0; d < 3; d++) periodic[d] = sph_sim_periodic(w->sim, d, &origin[d], &length[d]);
  sph_h5_integer(h5, parameters, "Periodic", 3, periodic);
  sph_h5_real(h5, parameters, "BoxOrigin", 3, origin);
  sph_h5_real(h5, parameters, "BoxLength", 3, length);
  if (case_text) sph_h5_text(h5, parameters, "Case", case_text);
  if (parameters >= 0) H5Gclose(parameters);
  hid_t units = sph_h5_group(h5, w->file, "Units");
  sph_h5_string(h5, units, "System", "SI; masses per metre in 2D, per square metre in 1D");
  sph_h5_real(h5, units, "UnitLength_in_cm", 0, (double[]){100});
  sph_h5_real(h5, units, "UnitMass_in_g", 0, (double[]){1000});
  sph_h5_real(h5, units, "UnitVelocity_in_cm_per_s", 0, (double[]){100});
  if (units >= 0) H5Gclose(units);
}

static void write_all(writer *w, const char *case_text, const char *command)
{
  write_header(w);
  write_groups(w);
  write_provenance(w, case_text, command);
  for (int part = 0; part < SPH_PARTS; part++) {
    if (w->n[part] == 0) continue;
    write_part(w, part);
    write_vtk(w, part);
  }
}

/* A field of some group that snapshots hold; all of them to words. */
static int is_saved(const sph_sim *sim, const char *name, sph_words *words)
{
  const sph_group *group;
  const sph_field_info *field;
  int found = 0;
  for (int g = 0; (group = sph_sim_group_get(sim, g)); g++)
    for (int k = 0; (field = sph_group_field(group, k)); k++) {
      /* of barotropic fluids snapshots hold the elastic energy */
      const int is_there = sph_group_read(group, field->name, 0) || !strcmp(field->name, "energy");
      if (!field->saved || !is_there) continue;
      found |= !strcmp(field->name, name);
      if (!sph_table_listed(words->known, field->name)) sph_words_add(words, field->name);
    }
  return found;
}

int sph_snapshot_check_fields(const sph_sim *sim, const char *fields, sph_error *error)
{
  static const char *const numbers[] = {"smoothing_length", "id", "group"};
  char word[64];
  for (const char *at = fields; at && *(at += strspn(at, " ,")); at += strcspn(at, " ,")) {
    snprintf(word, sizeof word, "%.*s", (int)strcspn(at, " ,"), at);
    sph_words words = {.wanted = word};
    int known = is_saved(sim, word, &words);
    for (int k = 0; k < 3; k++) known |= !strcmp(word, numbers[k]);
    if (!known)
      return sph_error_set(error, SPH_ERR_ARGUMENT,
                           "fields: no group has a field \"%.60s\"; %sthere are: %s", word,
                           words.nearest, words.known);
  }
  return SPH_OK;
}

void *sph_snapshot_image(const char *name, sph_sim *sim, const sph_hdf5_def *def, size_t *size,
                         sph_error *error)
{
  writer w = {.sim = sim, .dim = sph_sim_dim(sim), .single = def->single, .fields = def->fields};
  count_particles(&w);
  long larger = w.n[SPH_FLUIDS] > w.n[SPH_WALLS] ? w.n[SPH_FLUIDS] : w.n[SPH_WALLS];
  w.buffer = sph_memory_new(3 * (size_t)larger + 1, sizeof(double), "a snapshot", error);
  if (!w.buffer) return NULL;
  sph_h5_enter(&w.h5);
  w.h5.compression = def->compression;
  w.file = sph_h5_create(&w.h5, name);
  write_all(&w, def->case_text, def->command);
  void *image = sph_h5_close(&w.h5, w.file, size);
  sph_h5_leave(&w.h5);
  sph_memory_free(w.buffer);
  if (!image)
    sph_error_set(error, SPH_ERR_MEMORY, "%s: HDF5 could not make the snapshot of %ld particles",
                  name, w.n[SPH_FLUIDS] + w.n[SPH_WALLS]);
  return image;
}

void *sph_snapshot_image_walls(const char *target, size_t *size, sph_error *error)
{
  sph_h5 h5;
  sph_h5_enter(&h5);
  hid_t file = sph_h5_create(&h5, "walls");
  if (file >= 0 && H5Lcreate_external(target, vtk_names[SPH_WALLS], file, vtk_names[SPH_FLUIDS],
                                      H5P_DEFAULT, H5P_DEFAULT) < 0)
    h5.failed = 1;
  void *image = sph_h5_close(&h5, file, size);
  sph_h5_leave(&h5);
  if (!image)
    sph_error_set(error, SPH_ERR_MEMORY, "%s: HDF5 could not make a link to its walls", target);
  return image;
}
