/* Events whose moment has passed before the run begins. */
#include <math.h>

#include "sim_event.h"
#include "sim_warning.h"

void sph_sim_warning_events(sph_finder *f, const sph_sim *sim)
{
  for (int k = 0; k < sim->watches; k++) {
    const sph_watch *w = &sim->watch[k];
    const char *type = sph_event_type(w->type);
    double q = NAN;
    if (!type || w->direction == 0 || sph_event_known(w) || sph_event_steady(w)) continue;
    if (sph_event_measure((sph_sim *)sim, w, &q)) return; /* it writes nothing but an error */
    const double level = sph_event_threshold(w);
    if (!((q - level) * w->direction > 0)) continue;
    if (*type == 'w' || *type == 'd')
      sph_sim_warning_found(f,
                            "event %s: its point is %s when the run begins: it happens only after "
                            "that has changed",
                            w->name, q > level ? "wet" : "dry");
    else
      sph_sim_warning_found(f,
                            "event %s: its %s is %.4g %s when the run begins, %s %.4g %s already: "
                            "it happens only after that has gone back",
                            w->name, type, q, sph_event_unit(type), q > level ? "above" : "below",
                            level, sph_event_unit(type));
  }
}
