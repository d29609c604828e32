/* libFuzzer: a checkpoint is refused with a message that names it, or its run goes on from it.  The
 * first byte chooses: any bytes as a file; or a good checkpoint whose items are taken out, or have
 * others put in their place, with a header that is right.  Bytes of HDF5's own are not changed
 * behind a right checksum: what would be found is HDF5's. */
#include "fuzz_file.h"

#include <string.h>

#include "checkpoint_file.h"
#include "memory.h"
#include "sphode.h"

enum { MOST = 256, NAME = 200 };

typedef struct items {
  int n;
  char name[MOST][NAME];
} items;

/* Water at rest, a wall that has moved, an event, two steps. */
static sph_sim *make(void)
{
  const double lower[2] = {0, 0}, upper[2] = {0.4, 0.4}, far[2] = {0.4, 0.6};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  sph_group *water = sph_group_box(sim, "water", lower, upper, 1000);
  sph_group *tank = sph_group_walls(sim, "tank", lower, far, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  sph_group_set_boundary(tank, sph_boundary_adami());
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -1, 0}));
  sph_sim_add_event(sim, &(sph_event){.name = "a", .type = "time", .threshold = 5});
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "verlet-dual"});
  if (sph_sim_status(sim)) abort();
  return sim;
}

static herr_t gather(hid_t where, const char *name, const H5O_info_t *info, void *ctx)
{
  items *all = ctx;
  (void)where;
  if (info->type == H5O_TYPE_DATASET && all->n < MOST && strlen(name) < NAME)
    strcpy(all->name[all->n++], name);
  return 0;
}

/* Another one in the place of an item, or none. */
static void change(hid_t file, const char *name, const uint8_t *how)
{
  const hid_t types[] = {H5T_IEEE_F64LE, H5T_STD_I64LE, H5T_STD_U8LE, H5T_C_S1, H5T_IEEE_F32LE};
  const hid_t type = types[how[0] % 5];
  const hsize_t n = how[1] & 0x80 ? 0 : how[1] & 0x7f;
  static uint8_t bytes[128 * 8];
  for (size_t k = 0; k < sizeof bytes; k++) bytes[k] = (uint8_t)(how[2] * k + how[3]);
  H5Ldelete(file, name, H5P_DEFAULT);
  if (how[0] & 0x80) return;
  hid_t space = how[0] & 0x40 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &n, NULL);
  hid_t made = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (made >= 0) H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes);
  if (made >= 0) H5Dclose(made);
  H5Sclose(space);
}

/* A file like `good`, five bytes a change. */
static void write_changed(const char *path, const unsigned char *good, size_t bytes,
                          const uint8_t *data, size_t size)
{
  static items all;
  sph_h5 h5;
  sph_error error = {0};
  size_t length = 0;
  sph_h5_enter(&h5);
  hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, 1 << 20, 0);
  H5Pset_file_image(access, (void *)(good + SPH_CHECKPOINT_HEADER), bytes - SPH_CHECKPOINT_HEADER);
  hid_t file = H5Fopen("changed", H5F_ACC_RDWR, access);
  H5Pclose(access);
  if (file < 0) abort();
  all.n = 0;
  H5Ovisit1(file, H5_INDEX_NAME, H5_ITER_NATIVE, gather, &all);
  for (; all.n && size >= 5; data += 5, size -= 5)
    change(file, all.name[data[0] % all.n], data + 1);
  unsigned char *image = sph_h5_close_behind(&h5, file, SPH_CHECKPOINT_HEADER, &length);
  sph_h5_leave(&h5);
  if (!image || sph_checkpoint_file_write(path, image, length, &error)) abort();
  sph_memory_free(image);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static unsigned char *good;
  static size_t bytes;
  sph_error error = {0};
  sph_checkpoint_info info;
  if (!good) {
    const char *const set[] = {"a=1"};
    const sph_checkpoint_def def = {.case_path = "a.yml",
                                    .case_text = "a: 1\n",
                                    .sets = 1,
                                    .set = set};
    sph_sim *sim = make();
    if (sph_sim_step(sim) || sph_sim_step(sim)) abort();
    good = sph_checkpoint_image("good", sim, &def, &bytes, &error);
    sph_sim_free(sim);
    if (!good) abort();
  }
  if (!size) return 0;
  const char *path = fuzz_file("a.hdf", data + 1, size - 1);
  if (data[0] & 1) write_changed(path, good, bytes, data + 1, size - 1);
  if (sph_checkpoint_info_read(path, &info, &error)) {
    if (!strstr(error.text, path)) abort();
    return 0;
  }
  sph_checkpoint_info_free(&info);
  sph_sim *sim = make();
  if (sph_checkpoint_read(sim, path)) {
    if (!strstr(sph_sim_error(sim), path)) abort();
  } else {
    sph_sim_step(sim);
  }
  sph_sim_free(sim);
  return 0;
}
