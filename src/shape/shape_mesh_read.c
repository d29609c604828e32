/* Files of triangles: STL, binary and ASCII, and the corners and faces of Wavefront OBJ. */
#include <errno.h>
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "memory.h"
#include "shape_mesh.h"

static const double MOST = 2e7; /* triangles, corners */

typedef struct reader {
  const char *path;
  char *text; /* [size + 1], a NUL behind */
  size_t size;
  sph_shape_mesh *mesh;
  int corner_room, triangle_room;
  sph_error *error;
} reader;

static int load(reader *r)
{
  FILE *file = fopen(r->path, "rb");
  if (!file)
    return sph_error_set(r->error, SPH_ERR_FILE, "%s: cannot open: %s", r->path, strerror(errno));
  int status = SPH_OK;
  size_t room = 0, got = 1;
  while (!status && got > 0) {
    void *text = r->text;
    status = sph_memory_grow(&text, room, 2 * room + (1 << 16), 1, "a surface", r->error);
    r->text = text;
    if (status || !text) break;
    room = 2 * room + (1 << 16);
    got = fread(r->text + r->size, 1, room - r->size - 1, file);
    r->size += got;
    if (r->size > 3u << 30)
      status = sph_error_set(r->error, SPH_ERR_FILE, "%s: more than 3 GiB", r->path);
  }
  if (!status && ferror(file))
    status = sph_error_set(r->error, SPH_ERR_FILE, "%s: cannot read: %s", r->path, strerror(errno));
  fclose(file);
  return status;
}

static int too_many(const reader *r, double n)
{
  if (n <= MOST) return SPH_OK;
  return sph_error_set(r->error, SPH_ERR_FILE, "%s: %g triangles or corners; at most %g", r->path,
                       n, MOST);
}

static int add_corner(reader *r, const double x[3])
{
  sph_shape_mesh *m = r->mesh;
  for (int d = 0; d < 3; d++)
    if (!isfinite(x[d]))
      return sph_error_set(r->error, SPH_ERR_FILE,
                           "%s: coordinate %d of corner %d is %g; a finite number is right",
                           r->path, d, m->corners, x[d]);
  if (m->corners == r->corner_room) {
    const int room = 2 * r->corner_room + 1024;
    int status = too_many(r, room / 2.);
    if (!status)
      status = sph_memory_grow((void **)&m->corner, (size_t)r->corner_room, (size_t)room,
                               sizeof *m->corner, "a surface", r->error);
    if (status) return status;
    r->corner_room = room;
  }
  memcpy(m->corner[m->corners++], x, sizeof *m->corner);
  return SPH_OK;
}

static int add_triangle(reader *r, int a, int b, int c)
{
  sph_shape_mesh *m = r->mesh;
  if (m->triangles == r->triangle_room) {
    const int room = 2 * r->triangle_room + 1024;
    int status = too_many(r, room / 2.);
    if (!status)
      status = sph_memory_grow((void **)&m->triangle, (size_t)r->triangle_room, (size_t)room,
                               sizeof *m->triangle, "a surface", r->error);
    if (status) return status;
    r->triangle_room = room;
  }
  const int t[3] = {a, b, c};
  memcpy(m->triangle[m->triangles++], t, sizeof t);
  return SPH_OK;
}

/* ---- STL */

static uint32_t count_of(const reader *r) /* little endian */
{
  const unsigned char *n = (const unsigned char *)r->text + 80;
  return n[0] | (uint32_t)n[1] << 8 | (uint32_t)n[2] << 16 | (uint32_t)n[3] << 24;
}

static double float_of(const char *at)
{
  const unsigned char *b = (const unsigned char *)at;
  const uint32_t bits = b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

/* 80 bytes, the number, and for each triangle 12 floats (normal, corners) and 2 bytes. */
static int read_binary(reader *r)
{
  const uint32_t n = count_of(r);
  int status = too_many(r, n);
  for (uint32_t k = 0; k < n && !status; k++) {
    const char *at = r->text + 84 + 50 * (size_t)k + 12;
    const int first = r->mesh->corners;
    for (int c = 0; c < 3 && !status; c++, at += 12) {
      const double x[3] = {float_of(at), float_of(at + 4), float_of(at + 8)};
      status = add_corner(r, x);
    }
    if (!status) status = add_triangle(r, first, first + 1, first + 2);
  }
  return status;
}

/* A line of the text, its end made a NUL; NULL behind the last. */
static char *next_line(char **rest)
{
  char *line = *rest;
  if (!line || !*line) return NULL;
  char *end = line + strcspn(line, "\n");
  *rest = *end ? end + 1 : end;
  *end = 0;
  return line + strspn(line, " \t\r");
}

static int three(const reader *r, const char *text, int line, double x[3])
{
  for (int d = 0; d < 3; d++) {
    char *end;
    x[d] = strtod(text, &end);
    if (end == text)
      return sph_error_set(r->error, SPH_ERR_FILE, "%s:%d: three coordinates are right", r->path,
                           line);
    text = end;
  }
  return SPH_OK;
}

/* Three lines "vertex x y z" a facet. */
static int read_ascii(reader *r)
{
  char *rest = r->text, *line;
  int status = SPH_OK;
  for (int n = 1; !status && (line = next_line(&rest)); n++) {
    double x[3] = {0};
    if (strncmp(line, "vertex", 6) != 0) continue;
    status = three(r, line + 6, n, x);
    if (!status) status = add_corner(r, x);
    if (!status && r->mesh->corners % 3 == 0)
      status = add_triangle(r, r->mesh->corners - 3, r->mesh->corners - 2, r->mesh->corners - 1);
  }
  if (!status && r->mesh->corners % 3 != 0)
    status = sph_error_set(r->error, SPH_ERR_FILE,
                           "%s: %d lines 'vertex': cut short, three a triangle are right", r->path,
                           r->mesh->corners);
  return status;
}

static int read_stl(reader *r)
{
  if (r->size >= 84 && r->size == 84 + 50 * (size_t)count_of(r)) return read_binary(r);
  if (r->size >= 5 && !memcmp(r->text, "solid", 5) && memchr(r->text, '\n', r->size))
    return read_ascii(r);
  if (r->size < 84)
    return sph_error_set(r->error, SPH_ERR_FILE, "%s: %zu bytes are no STL file", r->path, r->size);
  return sph_error_set(r->error, SPH_ERR_FILE,
                       "%s: %zu bytes, its head tells of %lu triangles, which take %zu: no STL "
                       "file, or cut short",
                       r->path, r->size, (unsigned long)count_of(r), 84 + 50 * (size_t)count_of(r));
}

/* ---- OBJ */

/* "12/3/4": the corner 12, "-1": the last one so far. */
static int corner_of(const reader *r, char **text, int line, int *corner)
{
  char *end;
  const long n = strtol(*text, &end, 10);
  const long k = n > 0 ? n - 1 : r->mesh->corners + n;
  if (end == *text || n == 0 || k < 0 || k >= r->mesh->corners)
    return sph_error_set(r->error, SPH_ERR_FILE,
                         "%s:%d: found '%.20s'; the number of a corner above is right, 1 to %d",
                         r->path, line, *text, r->mesh->corners);
  *corner = (int)k;
  *text = end + strcspn(end, " \t\r");
  *text += strspn(*text, " \t\r");
  return SPH_OK;
}

/* A face of any number of corners: triangles around the first. */
static int add_face(reader *r, char *text, int line)
{
  int first = 0, before = 0, corner = 0, n = 0, status = SPH_OK;
  for (text += strspn(text, " \t"); *text && !status; n++) {
    status = corner_of(r, &text, line, &corner);
    if (n == 0) first = corner;
    if (!status && n >= 2) status = add_triangle(r, first, before, corner);
    before = corner;
  }
  if (status || n >= 3) return status;
  return sph_error_set(r->error, SPH_ERR_FILE, "%s:%d: a face of %d corners; 3 or more are right",
                       r->path, line, n);
}

static int read_obj(reader *r)
{
  char *rest = r->text, *line;
  int status = SPH_OK;
  for (int n = 1; !status && (line = next_line(&rest)); n++) {
    double x[3] = {0};
    line[strcspn(line, "#")] = 0;
    if (line[0] == 'v' && (line[1] == ' ' || line[1] == '\t')) {
      status = three(r, line + 1, n, x);
      if (!status) status = add_corner(r, x);
    } else if (line[0] == 'f' && (line[1] == ' ' || line[1] == '\t')) {
      status = add_face(r, line + 1, n);
    }
  }
  return status;
}

/* ---- one corner a place */

typedef struct place {
  double x[3];
  int corner;
} place;

static int by_place(const void *a, const void *b)
{
  const place *p = a, *q = b;
  for (int d = 0; d < 3; d++)
    if (p->x[d] != q->x[d]) return p->x[d] > q->x[d] ? 1 : -1;
  return (p->corner > q->corner) - (p->corner < q->corner);
}

static int same(const place *p, const place *q)
{
  return p->x[0] == q->x[0] && p->x[1] == q->x[1] && p->x[2] == q->x[2];
}

static int merge(const reader *r)
{
  sph_shape_mesh *m = r->mesh;
  place *places = SPH_NEW(place, m->corners, "corners of a surface", r->error);
  int *as = SPH_NEW(int, m->corners, "corners of a surface", r->error), n = 0, kept = 0;
  for (int k = 0; places && k < m->corners; k++) {
    places[k].corner = k;
    for (int d = 0; d < 3; d++) places[k].x[d] = m->corner[k][d] + 0.; /* -0 is 0 */
  }
  int status = places && as ? SPH_OK : SPH_ERR_MEMORY;
  if (!status) qsort(places, (size_t)m->corners, sizeof *places, by_place);
  for (int k = 0; k < m->corners && !status; k++) {
    if (k == 0 || !same(places + k, places + k - 1))
      memcpy(m->corner[n++], places[k].x, sizeof *m->corner);
    as[places[k].corner] = n - 1;
  }
  for (int k = 0; k < m->triangles && !status; k++) {
    const int *t = m->triangle[k], a = as[t[0]], b = as[t[1]], c = as[t[2]];
    const int whole[3] = {a, b, c};
    if (a != b && b != c && c != a) memcpy(m->triangle[kept++], whole, sizeof whole);
  }
  if (!status) {
    m->corners = n;
    m->triangles = kept;
  }
  sph_memory_free(places);
  sph_memory_free(as);
  return status;
}

static int ends(const char *path, const char *end)
{
  const size_t a = strlen(path), b = strlen(end);
  if (a < b) return 0;
  for (size_t k = 0; k < b; k++)
    if ((path[a - b + k] | 32) != end[k]) return 0; /* .STL, too */
  return 1;
}

int sph_shape_mesh_read(sph_shape_mesh *mesh, const char *path, double unit, sph_error *error)
{
  reader r = {.path = path, .mesh = mesh, .error = error};
  *mesh = (sph_shape_mesh){0};
  if (!ends(path, ".stl") && !ends(path, ".obj"))
    return sph_error_set(error, SPH_ERR_ARGUMENT, "%s: known are .stl, .obj", path);
  int status = load(&r);
  if (!status) status = ends(path, ".stl") ? read_stl(&r) : read_obj(&r);
  if (!status) status = merge(&r);
  if (!status && mesh->triangles == 0)
    status = sph_error_set(error, SPH_ERR_FILE, "%s: holds no triangles", path);
  for (int k = 0; k < mesh->corners && !status; k++)
    for (int d = 0; d < 3; d++) mesh->corner[k][d] *= unit;
  sph_memory_free(r.text);
  if (status) sph_shape_mesh_free(mesh);
  return status;
}
