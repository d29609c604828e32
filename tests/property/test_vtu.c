/* Files that VTK's own writers made (tests/data/vtu), in each way that its formats have, come in as
 * the numbers that went into them; whatever is cut off or damaged is told, or comes in, and nothing
 * worse happens. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../folder.h"
#include "../near.h"
#include "../quick.h"
#include "sphode.h"

enum { POINTS = 12 };
static const char *const files[] = {"ascii.vtu",
                                    "binary-wide.vtu",
                                    "binary-zlib.vtu",
                                    "binary-raw-big.vtu",
                                    "appended-zlib.vtu",
                                    "appended-wide-single.vtu",
                                    "appended-raw.vtp",
                                    "appended-raw-big.vtu",
                                    "appended-base64-single.vtu",
                                    "appended-base64-zlib-wide.vtu"};
enum { FILES = sizeof files / sizeof *files };

static char folder[FOLDER_MAX];
static char bad[2 * FOLDER_MAX];

static sph_sim *read_file(const char *path)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  sph_group *water = sph_group_create(sim, "water", "fluid");
  sph_group_set_eos(water, sph_eos_linear(1000, 10, -INFINITY));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_import(sim, water, &(sph_import_def){.path = path, .rho0 = 1000});
  return sim;
}

/* Without Expat there is nothing to test but that this is told. */
static int is_built(void)
{
  sph_sim *sim = read_file("none.vtu");
  const int built = sph_sim_status(sim) != SPH_ERR_UNBUILT;
  if (!built) assert_non_null(strstr(sph_sim_error(sim), "none.vtu: "));
  if (!built) assert_non_null(strstr(sph_sim_error(sim), "libexpat1-dev"));
  sph_sim_free(sim);
  return built;
}

static const char *source(const char *name)
{
  static char path[4096];
  const char *root = getenv("SRCDIR");
  snprintf(path, sizeof path, "%s/tests/data/vtu/%s", root ? root : ".", name);
  return path;
}

static void vtk_s_own_files(void **state)
{
  (void)state;
  for (int f = 0; f < FILES && is_built(); f++) {
    sph_sim *sim = read_file(source(files[f]));
    if (sph_sim_status(sim)) fail_msg("%s", sph_sim_error(sim));
    const sph_group *water = sph_sim_group(sim, "water");
    assert_int_equal(sph_group_count(water), POINTS);
    const int single = strstr(files[f], "single") != NULL;
    for (int i = 0; i < POINTS; i++) {
      for (int d = 0; d < 2; d++) {
        const double x = 0.1 * (d ? i / 4 : i % 4), v = d ? -0.5 * i : i;
        assert_near(sph_group_read(water, "position", d)[i], single ? (float)x : x, 1e-16);
        assert_near(sph_group_read(water, "velocity", d)[i], v, 0);
      }
      assert_near(sph_group_read(water, "density", 0)[i], 1000 + 0.25 * i, 0);
      assert_near(sph_group_read(water, "mass", 0)[i], 10 + i, 0);
    }
    sph_sim_free(sim);
  }
}

static void write_bytes(const void *data, size_t size)
{
  FILE *file = fopen(bad, "wb");
  if (!file || fwrite(data, 1, size, file) != size || fclose(file))
    fail_msg("%s cannot be written", bad);
}

static char *bytes_of(const char *path, size_t *size)
{
  static char data[1 << 16];
  FILE *file = fopen(path, "rb");
  if (!file) fail_msg("no %s", path);
  *size = fread(data, 1, sizeof data, file);
  fclose(file);
  return data;
}

/* Told, with the file, or read: then all of it is finite. */
static int told_or_read(void)
{
  sph_sim *sim = read_file(bad);
  const int status = sph_sim_status(sim);
  if (status && !strstr(sph_sim_error(sim), bad)) fail_msg("no file: %s", sph_sim_error(sim));
  if (!status) assert_true(sph_group_count(sph_sim_group(sim, "water")) > 0);
  sph_sim_free(sim);
  return status;
}

static void cut_off(void **state)
{
  (void)state;
  for (int f = 0; f < FILES && is_built(); f++) {
    size_t size, whole = 0;
    const char *data = bytes_of(source(files[f]), &size);
    for (size_t n = 0; n <= size; n += 3 * (size_t)quick_stride()) {
      write_bytes(data, n);
      whole += told_or_read() == SPH_OK;
    }
    /* Of appended data, cells and some words are behind what is needed; else the end of the XML. */
    if (!strncmp(files[f], "appended", 8))
      assert_in_range(whole, 1, size / 9);
    else
      assert_in_range(whole, 0, 1);
  }
}

static void damaged(void **state)
{
  (void)state;
  static const unsigned char values[] = {0, 0xff, '<', '"', '9', 'A', ' '};
  for (int f = 0; f < FILES && is_built(); f++) {
    size_t size;
    char *data = bytes_of(source(files[f]), &size);
    for (size_t n = 0; n < size; n += 3 * (size_t)quick_stride()) {
      const char kept = data[n];
      data[n] = (char)values[n % sizeof values];
      write_bytes(data, size);
      told_or_read();
      data[n] = kept;
    }
  }
}

#define HEAD "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
#define PIECE "<Piece NumberOfPoints=\"1\" NumberOfCells=\"0\">\n"
#define XYZ                                                                            \
  "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">1 2 " \
  "3</DataArray></Points>"
#define TAIL "</Piece></UnstructuredGrid></VTKFile>\n"

static void each_is_told(void **state)
{
  (void)state;
  static const char *const cases[][2] = {
      {"", "bad.vtu:1:1: no XML: no element found"},
      {"x,y\n1,2\n", "bad.vtu:1:1: no XML"},
      {"<a/>", "bad.vtu:1:1: <a>; <VTKFile> is right"},
      {"<VTKFile type=\"ImageData\"/>",
       "type=\"ImageData\"; UnstructuredGrid and PolyData are known"},
      {"<VTKFile type=\"PolyData\" byte_order=\"Middle\"/>", "byte_order=\"Middle\""},
      {"<VTKFile type=\"PolyData\" header_type=\"UInt16\"/>", "header_type=\"UInt16\""},
      {"<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"/>",
       "compressor=\"vtkLZ4DataCompressor\"; vtkZLibDataCompressor is known, or none"},
      {"<!DOCTYPE a [<!ENTITY b \"c\">]><VTKFile/>", "a DOCTYPE has no place"},
      {HEAD "<Piece>" XYZ TAIL, "bad.vtu:3:1: no NumberOfPoints"},
      {HEAD "<Piece NumberOfPoints=\"-1\">" XYZ TAIL, "NumberOfPoints=\"-1\"; a whole number"},
      {HEAD "<Piece NumberOfPoints=\"999999999999\">" XYZ TAIL, "999999999999 points in a file of"},
      {HEAD PIECE TAIL, "no Points of three components"},
      {HEAD "<Piece NumberOfPoints=\"0\"></Piece></UnstructuredGrid></VTKFile>", "no particles"},
      {HEAD "<Piece NumberOfPoints=\"2\">\n" XYZ TAIL,
       "bad.vtu:4: position (Float64): number 3 of 6 is missing or no number"},
      {HEAD PIECE XYZ "<PointData><DataArray type=\"Float32\" Name=\"density\">1 "
                      "2</DataArray></PointData>" TAIL,
       "bad.vtu:4: density (Float32): more behind its 1 numbers"},
      {HEAD PIECE XYZ "<PointData><DataArray type=\"Float32\" Name=\"density\">one</DataArray>"
                      "</PointData>" TAIL,
       "density (Float32): number 0 of 1"},
      {HEAD PIECE XYZ "<PointData><DataArray type=\"Float32\" Name=\"density [g/cm]\">1"
                      "</DataArray></PointData>" TAIL,
       "density in g/cm; right is kg/m^3"},
      {HEAD PIECE XYZ "<PointData><DataArray type=\"Float16\" Name=\"density\">1</DataArray>"
                      "</PointData>" TAIL,
       "type=\"Float16\"; Float64, Float32"},
      {HEAD PIECE XYZ "<PointData><DataArray type=\"Float32\" Name=\"velocity\">1</DataArray>"
                      "</PointData>" TAIL,
       "velocity is no vector"},
      {HEAD PIECE XYZ "<PointData><DataArray type=\"Float32\" Name=\"mass\">1</DataArray>"
                      "<DataArray type=\"Float32\" Name=\"Masses\">1</DataArray></PointData>" TAIL,
       "mass a second time"},
      {HEAD PIECE XYZ "<PointData><DataArray type=\"Float32\" Name=\"mass\" format=\"binary\">"
                      "BAAAAA</DataArray></PointData>" TAIL,
       "mass (Float32): the data end too early"},
      {HEAD PIECE XYZ "<PointData><DataArray type=\"Float32\" Name=\"mass\" format=\"binary\">"
                      "CAAAAAAAgD8AAIA/</DataArray></PointData>" TAIL,
       "mass (Float32): 8 bytes where 4 would be right"},
      {HEAD PIECE XYZ "<PointData><DataArray type=\"Float32\" Name=\"mass\" format=\"binary\">"
                      "BAAA!AAAgD8=</DataArray></PointData>" TAIL,
       "byte 0x21 is neither base64 nor the end"},
      {HEAD PIECE XYZ "<PointData><DataArray type=\"Float32\" Name=\"mass\" format=\"appended\" "
                      "offset=\"0\"/></PointData>" TAIL,
       "mass (Float32): its appended data are not in the file"},
      {HEAD PIECE XYZ "<PointData><DataArray type=\"Float32\" Name=\"mass\" format=\"appended\" "
                      "offset=\"999\"/></PointData></Piece></UnstructuredGrid><AppendedData "
                      "encoding=\"raw\">_1234</AppendedData></VTKFile>",
       "its appended data are not in the file"},
      {HEAD PIECE XYZ TAIL "<", "no XML: "},
      {HEAD PIECE XYZ "</Piece>" PIECE XYZ
                      "<PointData><DataArray type=\"Float32\" Name=\"mass\">1</DataArray>"
                      "</PointData>" TAIL,
       "mass of 1 of 2 points"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases && is_built(); k++) {
    write_bytes(cases[k][0], strlen(cases[k][0]));
    sph_sim *sim = read_file(bad);
    if (!strstr(sph_sim_error(sim), cases[k][1]))
      fail_msg("\"%s\" not in: %s", cases[k][1], sph_sim_error(sim));
    sph_sim_free(sim);
  }
}

/* Pieces one after the other; the first has no points. */
static void pieces(void **state)
{
  (void)state;
  static const char text[] = HEAD
      "<Piece NumberOfPoints=\"0\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
      "format=\"ascii\"/></Points></Piece>" PIECE XYZ "</Piece>" PIECE XYZ TAIL;
  if (!is_built()) return;
  write_bytes(text, strlen(text));
  sph_sim *sim = read_file(bad);
  if (sph_sim_status(sim)) fail_msg("%s", sph_sim_error(sim));
  const sph_group *water = sph_sim_group(sim, "water");
  assert_int_equal(sph_group_count(water), 2);
  for (int i = 0; i < 2; i++) assert_near(sph_group_read(water, "position", 1)[i], 2, 0);
  sph_sim_free(sim);
}

static int make(void **state)
{
  (void)state;
  const int status = folder_make(folder, "vtu");
  snprintf(bad, sizeof bad, "%s/bad.vtu", folder);
  return status;
}

static int clean(void **state)
{
  (void)state;
  return folder_remove(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(vtk_s_own_files), cmocka_unit_test(pieces),
                                     cmocka_unit_test(each_is_told), cmocka_unit_test(cut_off),
                                     cmocka_unit_test(damaged)};
  return cmocka_run_group_tests_name("vtu", tests, make, clean);
}
