/* A header of 512 bytes of text, then HDF5, which finds itself behind it:
 *
 *   sphode checkpoint
 *   format 1
 *   version 0.3.0
 *   bytes 123456                 of the HDF5 part
 *   fnv1a 0123456789abcdef       checksum of the version and it (Fowler, Noll, Vo): each byte steps
 *                                the sum by a bijection, so that no damaged byte stays unseen
 *   (empty lines)
 *
 * The header has no room for anything else: it is compared with the one that its values give. */
#include "checkpoint_file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "file.h"
#include "memory.h"

enum { FORMAT = 1, HEADER = SPH_CHECKPOINT_HEADER };

static uint64_t add(uint64_t sum, const unsigned char *data, size_t size)
{
  for (size_t i = 0; i < size; i++) sum = (sum ^ data[i]) * 1099511628211u;
  return sum;
}

static uint64_t checksum(const char *version, const unsigned char *data, size_t size)
{
  const uint64_t start = 14695981039346656037u;
  return add(add(start, (const unsigned char *)version, strlen(version)), data, size);
}

static void make_header(char header[HEADER + 1], const char *version, size_t bytes, uint64_t sum)
{
  int used = snprintf(header, HEADER,
                      "sphode checkpoint\nformat %d\nversion %s\nbytes %zu\nfnv1a %016" PRIx64 "\n",
                      FORMAT, version, bytes, sum);
  memset(header + used, '\n', (size_t)(HEADER - used));
}

int sph_checkpoint_file_write(const char *path, unsigned char *image, size_t size, sph_error *error)
{
  char header[HEADER + 1];
  const size_t bytes = size - HEADER;
  make_header(header, sph_version(), bytes, checksum(sph_version(), image + HEADER, bytes));
  memcpy(image, header, HEADER);
  return sph_file_replace(path, image, size, error);
}

typedef struct contents {
  unsigned char *data;
  size_t size;
} contents;

int sph_checkpoint_file_refuse(sph_error *error, const char *path, const char *why)
{
  return sph_error_set(error, SPH_ERR_FILE, "checkpoint %s: %s", path, why);
}

static int load(const char *path, contents *c, sph_error *error)
{
  FILE *file = path ? fopen(path, "rb") : NULL;
  if (!file)
    return sph_checkpoint_file_refuse(error, path ? path : "(NULL)",
                                      strerror(path ? errno : EINVAL));
  struct stat about;
  int status = SPH_OK;
  if (fstat(fileno(file), &about) != 0 || !S_ISREG(about.st_mode))
    status = sph_checkpoint_file_refuse(error, path, "it is no file");
  if (!status) {
    c->size = (size_t)about.st_size;
    c->data = sph_memory_new(c->size, 1, "a checkpoint", error);
    if (!c->data) status = SPH_ERR_MEMORY;
  }
  if (!status && fread(c->data, 1, c->size, file) != c->size)
    status = sph_checkpoint_file_refuse(error, path, "it cannot be read");
  fclose(file);
  return status;
}

/* Version, length and checksum. */
static int check(const char *path, const contents *c, sph_error *error)
{
  char given[HEADER + 1] = "", right[HEADER + 1], version[32];
  int format = 0;
  size_t bytes = 0;
  uint64_t sum = 0;
  memcpy(given, c->data, c->size < HEADER ? c->size : HEADER);
  if (sscanf(given, "sphode checkpoint\nformat %d\n", &format) != 1)
    return sph_checkpoint_file_refuse(error, path,
                                      "it is no checkpoint of sphode, or its header is damaged");
  if (format != FORMAT)
    return sph_error_set(error, SPH_ERR_FILE,
                         "checkpoint %s: it is of format %d; this sphode (%s) reads format %d",
                         path, format, sph_version(), FORMAT);
  if (sscanf(given, "sphode checkpoint\nformat %*d\nversion %31s\nbytes %zu\nfnv1a %" SCNx64,
             version, &bytes, &sum) != 3)
    return sph_checkpoint_file_refuse(error, path, "its header is damaged");
  make_header(right, version, bytes, sum);
  if (memcmp(given, right, HEADER) != 0)
    return sph_checkpoint_file_refuse(error, path, "its header is damaged");
  if (bytes != c->size - HEADER)
    return sph_error_set(error, SPH_ERR_FILE,
                         "checkpoint %s: it has %zu bytes, %zu are right: it was cut short", path,
                         c->size, bytes + HEADER);
  if (checksum(version, c->data + HEADER, bytes) == sum) return SPH_OK;
  return sph_checkpoint_file_refuse(error, path, "its checksum is wrong: it is damaged");
}

hid_t sph_checkpoint_file_open(const char *path, sph_h5 *h5, sph_error *error)
{
  contents c = {0};
  hid_t file = -1;
  char name[SPH_PATH];
  int status = load(path, &c, error);
  if (!status && c.data) status = check(path, &c, error);
  sph_h5_enter(h5);
  snprintf(name, sizeof name, "in memory: %s", path ? path : "");
  if (!status && c.data) file = sph_h5_open_image(name, c.data + HEADER, c.size - HEADER);
  if (!status && file < 0) sph_checkpoint_file_refuse(error, path, "HDF5 cannot read it");
  sph_memory_free(c.data);
  return file;
}

void sph_checkpoint_file_close(hid_t file, sph_h5 *h5)
{
  if (file >= 0) H5Fclose(file);
  sph_h5_leave(h5);
}
