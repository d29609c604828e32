/* Pictures. */
#include <stdio.h>

#include "prog.h"

static int report(int status, const char *png, const sph_error *error)
{
  if (status == SPH_OK)
    printf("picture      %s\n", png);
  else
    sph_prog_error(PROG_FAILED, "no picture: %s", error->text);
  return status;
}

static int frames(const char *directory, const char *field, int n)
{
  char png[4096];
  sph_error error = {0};
  snprintf(png, sizeof png, "%s/frames.png", directory);
  return report(sph_plot_frames(directory, field, n, png, &error), png, &error);
}

void sph_prog_plot_case(const sph_case *c, const char *directory, int n)
{
  int status = frames(directory, sph_case_plot_field(c), sph_case_plot_frames(c));
  for (int k = 0; k < n && status != SPH_ERR_UNBUILT; k++) {
    char png[4096];
    sph_error error = {0};
    status = sph_case_compare_plot(c, k, directory, png, sizeof png, &error);
    if (status != SPH_ERR_ARGUMENT) report(status, png, &error); /* else: nothing to draw */
  }
}

int sph_prog_plot(const prog_options *o)
{
  char path[4096];
  sph_error none = {0};
  snprintf(path, sizeof path, "%s/case.yml", o->what);
  sph_case *c = sph_case_read(path, 0, NULL, &none); /* a run without a case: the defaults */
  const char *field = o->field ? o->field : c ? sph_case_plot_field(c) : NULL;
  int status = frames(o->what, field, o->frames ? o->frames : c ? sph_case_plot_frames(c) : 4);
  sph_case_free(c);
  return status == SPH_OK ? PROG_OK : PROG_FAILED;
}
