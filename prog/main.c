/* sphode -- the program. */
#include <getopt.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "prog.h"

typedef struct command {
  const char *name, *argument, *options; /* letters of those it takes */
  int (*run)(const prog_options *o);
  const char *about, *help;
} command;

static const command commands[] = {
    {"new", "[TEMPLATE]", "ofq", sph_prog_new, "write a case to begin with, with comments",
     "  TEMPLATE is tank (default), piston, channel, gas or piston-hill-3d (the tutorial's, with\n"
     "  hill.stl beside it); the file is TEMPLATE.yml here.\n"
     "\n"
     "  -o, --output FILE      another name; -: to standard output\n"
     "  -f, --force            write over a file\n"
     "  -q, --quiet            nothing is told\n"},
    {"run", "CASE.yml", "ostqfblw", sph_prog_run,
     "run a case; results, summary and pictures go to a directory",
     "  -o, --output DIR       where to (default: the name of the case file, here)\n"
     "  -s, --set KEY=VALUE    instead of what the file says: spacing=1cm, run.end=2s,\n"
     "                         parameters.H=0.3m, groups.water.density=900; repeatable\n"
     "  -t, --threads N        results do not depend on it\n"
     "  -f, --force            write over a run that ended, or one that can go on\n"
     "  -q, --quiet            no progress, no summary, no pictures, no warnings\n"
     "      --lenient          exit status 0, not 3, where a comparison misses its bar\n"
     "      --live[=PORT]      a page in the browser, at the address that is told: particles,\n"
     "                         series, pause, stop\n"
     "\n"
     "Exit status: 0 done, 1 failed or stopped from its page, 2 bad usage, 3 done, but a\n"
     "comparison misses its bar, 4 stopped by run.time_limit or before a queue's end, 130 or\n"
     "143 by Ctrl-C or SIGTERM (outputs and summary are whole where it was stopped, too, and\n"
     "restart goes on; a second Ctrl-C, a second or more later, ends it without).\n"},
    {"restart", "DIR", "sUtqblw", sph_prog_restart,
     "go on with a run that was killed, stopped or is to go further",
     "  From the last good checkpoint, with the case that it holds; files go on where they were.\n"
     "  Results have the same bits as without the interruption (relax: within 1e-8).\n"
     "\n"
     "      --until TIME       instead of the end of the case, as 0.1s\n"
     "  -s, --set KEY=VALUE    besides what was set then: run, integrator, checkpoint, intervals "
     "of\n"
     "                         output, events, plot, parameters of terms that the run has,\n"
     "                         viscosities; what the state was made with is refused.  The\n"
     "                         integrator starts anew from the state\n"
     "  -t, --threads N        as with run\n"
     "  -q, --quiet            as with run\n"
     "      --lenient          as with run\n"
     "      --live[=PORT]      as with run\n"
     "\n"
     "Exit status: as with run.\n"},
    {"check", "CASE.yml", "stK", sph_prog_check,
     "validate a case and estimate its cost; nothing but the picture, with its script and data, is "
     "written",
     "      --picture PNG      draw its groups; in 3D a slice through the middle\n"
     "  -s, --set KEY=VALUE    as with run\n"
     "  -t, --threads N        as with run\n"},
    {"sweep", "CASE.yml", "ostqflyJ", sph_prog_sweep,
     "run a case with several values of some keys; a table and orders of convergence",
     "      --vary KEY=V,V,... a run for each value: dx=2cm,1cm (a parameter),\n"
     "                         terms.delta.delta=0,0.1; repeated: all combinations\n"
     "      --jobs N           runs at a time (default: 1)\n"
     "  -o, --output DIR       where to, a directory a run in it (default: the name of the case "
     "file\n"
     "                         and -sweep, here)\n"
     "  -s, --set KEY=VALUE    as with run\n"
     "  -t, --threads N        of each run\n"
     "  -f, --force            all runs anew, over what an earlier sweep left\n"
     "  -q, --quiet            no table\n"
     "      --lenient          as with run\n"
     "\n"
     "Leaves sweep.csv, RUN/ and RUN.log of each run, and convergence.csv and convergence.png\n"
     "where there are comparisons.  Ctrl-C or SIGTERM stops its runs behind checkpoints; the same\n"
     "command goes on: runs that are done are kept, stopped ones go on, the rest begins.\n"
     "\n"
     "Exit status: 0 done, 1 a run failed (the others are kept), 3 a comparison misses its bar,\n"
     "4 a run was stopped by its time limit, 130 or 143 by Ctrl-C or SIGTERM.\n"},
    {"schema", "[FILE]", "f", sph_prog_schema,
     "the JSON Schema of case files, for editors, into a file or to standard output",
     "  In an editor with a YAML language server: sphode schema sphode.schema.json, and as the\n"
     "  first line of a case\n"
     "  # yaml-language-server: $schema=sphode.schema.json\n"
     "\n"
     "  -f, --force            write over a file\n"},
    {"info", "LIST", "jcQPD", sph_prog_info,
     "what there is: kernels, eos, materials, terms, integrators, boundaries, searches, case",
     "  LIST is kernels, eos, materials, terms, integrators, boundaries, searches, or case (the\n"
     "  manual of case files, Markdown)\n"
     "      --json             for programs\n"
     "      --csv --q LIST     kernels only: kernel,dim,q,W,dWdr,laplacian at h = 1 for each q of "
     "the list,\n"
     "                         as 0,0.25,1.3\n"
     "      --spacing DX       kernels only: h, support, neighbors, error of each at that spacing "
     "[m]\n"
     "      --dim N            in 1, 2 or 3 dimensions (default: 2 and 3)\n"},
    {"plot", "DIR", "FnadeW", sph_prog_plot,
     "draw a run again: its snapshots and comparisons, or curves of its tables",
     "      --field NAME       colour: velocity, pressure, density, energy, velocity_x, ...\n"
     "      --frames N         snapshots on the sheet\n"
     "      --at T,T,...       those nearest to these times instead, as 0.1,250ms\n"
     "      --series LIST      instead columns of series.csv over time, as front,kinetic, to\n"
     "                         DIR/series.png; a panel for each unit\n"
     "      --table FILE       of another table in DIR, as probe_line.csv, to DIR/probe_line.png;\n"
     "                         of a plane with --field COLUMN a map of it (--frames of them)\n"
     "      --over COLUMN      over this column instead of the first, as points\n"
     "\n"
     "With --at, --table and --over draw profiles of a table at these times, a curve each, and\n"
     "--series FIELD,... --over x, without a table, those of the particles of the snapshots, to\n"
     "DIR/profiles.png.\n"},
    {"movie", "DIR", "oFEBAq", sph_prog_movie,
     "draw all snapshots of a run, as an mp4 or animated PNG",
     "      --field NAME       colour: velocity, pressure, density, energy, velocity_x, ...\n"
     "      --range FROM:TO    of the colours, in SI units, as 0:2000 (default: all that the "
     "field\n"
     "                         has, the same in all frames)\n"
     "      --size WIDTHxHEIGHT  pixels, as 1280x720 (default: what the picture needs)\n"
     "      --rate N           frames a second (default: 25)\n"
     "  -o, --output FILE      x.mp4, or animated PNG: x.png, x.apng (default: DIR/movie.mp4)\n"
     "  -q, --quiet            nothing is told\n"
     "\n"
     "Wants gnuplot and ffmpeg.\n"},
    {"export", "DIR", "ocvGHLSqO", sph_prog_export,
     "snapshots as files that other tools read: CSV, VTU, GADGET's HDF5, SPLASH's text",
     "  DIR is the directory of a run, or one of its snapshots.\n"
     "\n"
     "      --format LIST      of csv, vtu, gadget, splash, with commas between; or one or more "
     "of\n"
     "      --csv              a table a snapshot and kind, and times.csv: gnuplot, pandas\n"
     "      --vtu              VTK's XML, and series with their times, .pvd: ParaView, VisIt\n"
     "      --gadget           GADGET's HDF5 layout: yt, pynbody\n"
     "      --splash           columns of text with the names that SPLASH knows, and the time\n"
     "      --fields LIST      names with commas between, as velocity,density (default: all)\n"
     "      --float32          numbers of single precision\n"
     "  -o, --output DIR       where to (default: DIR/csv, DIR/vtu, ...); of several formats to\n"
     "                         csv, vtu, ... in it\n"
     "  -q, --quiet            nothing is told\n"},
    {"work-precision", "CASE.yml", "ostqfFITCRUNXM", sph_prog_work_precision,
     "what each integrator needs for which temporal error",
     "      --integrators LIST   names with commas between, each with keys of its own behind a +:\n"
     "                           imex:ark324l2sa-4-2-3+linear=cholmod+terms.delta.part=implicit;\n"
     "                           those that are not imex or mri leave aside the parts of terms\n"
     "                           (default: erk:bogacki-shampine-4-2-3,leapfrog)\n"
     "      --tolerances LIST    of those with error control (default: 1e-1,1e-2,...,1e-5)\n"
     "      --cfl LIST           of the others: fixed steps, as fractions of the stability limit\n"
     "                           (default: 1,0.7,0.5,0.35,0.175,...; 0.35, or the cfl of the "
     "case,\n"
     "                           stands for the steps that the limits allow)\n"
     "      --fixed              fixed steps for all, without error control\n"
     "      --reference NAME     (default: erk:dormand-prince-7-4-5), in steps that are halved "
     "until\n"
     "                           its own error is a tenth of the least that was found\n"
     "      --until TIME         instead of the end of the case, as 0.1s\n"
     "      --repeat N           the quickest of N runs counts (default: 1)\n"
     "      --timeout N          a run that takes more than N seconds is stopped, and has failed\n"
     "      --field NAME         of the pictures and the summary (default: velocity)\n"
     "  -o, --output DIR         where to (default: the name of the case file and -work, here)\n"
     "  -s, --set KEY=VALUE      as with run\n"
     "  -t, --threads N          as with run\n"
     "  -f, --force              write over a run that ended\n"
     "  -q, --quiet              no progress, no table\n"
     "\n"
     "Leaves work-precision.csv, work-precision.txt, evaluations.png and seconds.png.\n"},
    {"spectrum", "CASE.yml", "ostqfIUZ", sph_prog_spectrum,
     "eigenvalues of a small case, and the longest stable step of each integrator",
     "      --frozen           positions are held: waves and friction on particles that stay "
     "where\n"
     "                         they are, and fewer eigenvalues (at most 4000; 1000 take 5 s)\n"
     "      --until TIME       of the state there, as 0.1s, instead of the start\n"
     "      --integrators LIST whose regions of stability the picture shows, with commas between\n"
     "                         (default: leapfrog,erk:bogacki-shampine-4-2-3,\n"
     "                         erk:dormand-prince-7-4-5,erk:rdpk3sp49-9-3-4)\n"
     "  -o, --output DIR       where to (default: the name of the case file and -spectrum, here)\n"
     "  -s, --set KEY=VALUE    as with run\n"
     "  -t, --threads N        as with run\n"
     "  -f, --force            write over what ended\n"
     "  -q, --quiet            no text, no progress\n"
     "\n"
     "Leaves spectrum.csv, spectrum.txt, regions.csv and spectrum.png.\n"},
};
enum { COMMANDS = sizeof commands / sizeof *commands };

static const struct option options[] = {
    {"output", required_argument, NULL, 'o'},
    {"set", required_argument, NULL, 's'},
    {"threads", required_argument, NULL, 't'},
    {"quiet", no_argument, NULL, 'q'},
    {"force", no_argument, NULL, 'f'},
    {"strict", no_argument, NULL, 'b'}, /* the default since 0.5.0 */
    {"lenient", no_argument, NULL, 'l'},
    {"live", optional_argument, NULL, 'w'},
    {"json", no_argument, NULL, 'j'},
    {"csv", no_argument, NULL, 'c'},
    {"q", required_argument, NULL, 'Q'},
    {"vtu", no_argument, NULL, 'v'},
    {"gadget", no_argument, NULL, 'G'},
    {"splash", no_argument, NULL, 'H'},
    {"format", required_argument, NULL, 'O'},
    {"fields", required_argument, NULL, 'L'},
    {"float32", no_argument, NULL, 'S'},
    {"spacing", required_argument, NULL, 'P'},
    {"dim", required_argument, NULL, 'D'},
    {"field", required_argument, NULL, 'F'},
    {"frames", required_argument, NULL, 'n'},
    {"series", required_argument, NULL, 'a'},
    {"table", required_argument, NULL, 'd'},
    {"over", required_argument, NULL, 'e'},
    {"at", required_argument, NULL, 'W'},
    {"range", required_argument, NULL, 'E'},
    {"size", required_argument, NULL, 'B'},
    {"rate", required_argument, NULL, 'A'},
    {"integrators", required_argument, NULL, 'I'},
    {"tolerances", required_argument, NULL, 'T'},
    {"cfl", required_argument, NULL, 'C'},
    {"reference", required_argument, NULL, 'R'},
    {"until", required_argument, NULL, 'U'},
    {"repeat", required_argument, NULL, 'N'},
    {"timeout", required_argument, NULL, 'M'},
    {"fixed", no_argument, NULL, 'X'},
    {"frozen", no_argument, NULL, 'Z'},
    {"vary", required_argument, NULL, 'y'},
    {"jobs", required_argument, NULL, 'J'},
    {"picture", required_argument, NULL, 'K'},
    {"help", no_argument, NULL, 'h'},
    {"version", no_argument, NULL, 'V'},
    {NULL, 0, NULL, 0},
};

int sph_prog_error(int status, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  fputs("sphode: ", stderr);
  vfprintf(stderr, format, arguments);
  fputc('\n', stderr);
  va_end(arguments);
  return status;
}

static void print_help(const command *c)
{
  if (c) {
    printf("Usage: sphode %s [OPTION]... %s\n\n%s.\n\n%s", c->name, c->argument, c->about, c->help);
    return;
  }
  puts("Usage: sphode COMMAND [OPTION]... ARGUMENT\n\n"
       "Smoothed particle hydrodynamics as a system of ordinary differential equations.\n");
  for (int k = 0; k < COMMANDS; k++)
    printf("  %-14s %-10s %s\n", commands[k].name, commands[k].argument, commands[k].about);
  puts("\n  sphode COMMAND --help   its options\n"
       "  sphode --version\n\n"
       "Exit status: 0 done, 1 failed, 2 bad usage; run and restart also 3, 4, 130, 143.");
}

static const command *find(const char *name)
{
  for (int k = 0; name && k < COMMANDS; k++)
    if (!strcmp(commands[k].name, name)) return &commands[k];
  return NULL;
}

/* Letters to insert, delete, replace or swap with the next one to make b of a: at most `most`, or
 * more than that. */
static int edits(const char *a, const char *b, int most)
{
  while (*a && *a == *b) a++, b++;
  if (!*a && !*b) return 0;
  if (most == 0) return 1;
  const int swapped = *a && *b && a[0] == b[1] && a[1] == b[0];
  const int way[] = {swapped ? edits(a + 2, b + 2, most - 1) : most,
                     *a ? edits(a + 1, b, most - 1) : most, *b ? edits(a, b + 1, most - 1) : most,
                     *a && *b ? edits(a + 1, b + 1, most - 1) : most};
  int least = most;
  for (int k = 0; k < 4; k++)
    if (way[k] < least) least = way[k];
  return least + 1;
}

static int no_command(const char *word)
{
  const char *nearest = NULL;
  for (int most = 1; word && most <= 2 && !nearest; most++)
    for (int k = 0; k < COMMANDS && !nearest; k++)
      if (3 * most <= (int)strlen(commands[k].name) && edits(word, commands[k].name, most) <= most)
        nearest = commands[k].name;
  if (nearest)
    sph_prog_error(PROG_USAGE, "'%s' is no command; did you mean '%s'?", word, nearest);
  else
    sph_prog_error(PROG_USAGE, word ? "'%s' is no command" : "no command", word ? word : "");
  fprintf(stderr, "Try 'sphode --help'.\n");
  return PROG_USAGE;
}

static const char *option_name(int letter)
{
  for (int k = 0; options[k].name; k++)
    if (options[k].val == letter) return options[k].name;
  return "";
}

static int number(const char *name, const char *text, int most, int *value)
{
  char *end;
  long n = strtol(text, &end, 10);
  *value = (int)n;
  if (end != text && !*end && n >= 1 && n <= most) return PROG_OK;
  return sph_prog_error(PROG_USAGE, "--%s %s: wanted a whole number from 1 to %d", name, text,
                        most);
}

static int take(prog_options *o, int letter, const char *value)
{
  switch (letter) {
  case 'o': o->output = value; break;
  case 't': return number("threads", value, PROG_THREADS, &o->threads);
  case 'n': return number("frames", value, PROG_FRAMES, &o->frames);
  case 'N': return number("repeat", value, PROG_REPEATS, &o->repeat);
  case 'M': return number("timeout", value, PROG_SECONDS, &o->timeout);
  case 'I': o->integrators = value; break;
  case 'T': o->tolerances = value; break;
  case 'C': o->cfl = value; break;
  case 'R': o->reference = value; break;
  case 'U': o->until = value; break;
  case 'X': o->fixed = 1; break;
  case 'Z': o->frozen = 1; break;
  case 'K': o->picture = value; break;
  case 'J': return number("jobs", value, PROG_JOBS, &o->jobs);
  case 'y':
    if (o->varied == PROG_VARIED)
      return sph_prog_error(PROG_USAGE, "more than %d times --vary", PROG_VARIED);
    o->vary[o->varied++] = value;
    break;
  case 'q': o->quiet = 1; break;
  case 'f': o->force = 1; break;
  case 'b': o->lenient = 0; break;
  case 'l': o->lenient = 1; break;
  case 'w': o->live = 1; return value ? number("live", value, PROG_PORTS, &o->port) : PROG_OK;
  case 'j': o->json = 1; break;
  case 'c': o->csv = 1; break;
  case 'v': o->vtu = 1; break;
  case 'G': o->gadget = 1; break;
  case 'H': o->splash = 1; break;
  case 'O': o->format = value; break;
  case 'L': o->fields = value; break;
  case 'S': o->single = 1; break;
  case 'Q': o->q = value; break;
  case 'P': o->spacing = value; break;
  case 'D': return number("dim", value, 3, &o->dim);
  case 'F': o->field = value; break;
  case 'a': o->series = value; break;
  case 'd': o->table = value; break;
  case 'e': o->over = value; break;
  case 'W': o->at = value; break;
  case 'E': o->range = value; break;
  case 'B': o->size = value; break;
  case 'A': return number("rate", value, PROG_RATE, &o->rate);
  case 's':
    if (o->sets == PROG_SETS)
      return sph_prog_error(PROG_USAGE, "more than %d times --set", PROG_SETS);
    o->set[o->sets++] = value;
    break;
  }
  return PROG_OK;
}

/* argv[0] is the command.  -1: go on, else an exit status. */
static int parse(const command *c, int argc, char **argv, prog_options *o)
{
  char name[] = "sphode", *first = argv[0];
  int letter, status = PROG_OK;
  argv[0] = name; /* getopt's messages begin with it */
  while (!status && (letter = getopt_long(argc, argv, "o:s:t:qfhV", options, NULL)) != -1) {
    if (letter == 'h') {
      print_help(c);
      return PROG_OK;
    }
    if (letter == '?')
      status = PROG_USAGE;
    else if (!strchr(c->options, letter))
      status = sph_prog_error(PROG_USAGE, "%s takes no --%s", c->name, option_name(letter));
    else
      status = take(o, letter, optarg);
  }
  argv[0] = first;
  const int given = argc - optind, must = c->argument[0] != '[';
  if (!status && (given < must || given > 1))
    status = sph_prog_error(PROG_USAGE, "%s wants %s %s, found %d", c->name,
                            must ? "one" : "at most one", c->argument, given);
  if (status) {
    fprintf(stderr, "Try 'sphode %s --help'.\n", c->name);
    return status;
  }
  o->what = given ? argv[optind] : NULL;
  return -1;
}

static void keep_command(prog_options *o, int argc, char **argv)
{
  size_t n = (size_t)snprintf(o->command, sizeof o->command, "sphode");
  for (int k = 1; k < argc && n < sizeof o->command; k++)
    n += (size_t)snprintf(o->command + n, sizeof o->command - n, " %s", argv[k]);
}

int main(int argc, char **argv)
{
  prog_options o = {0};
  const char *word = argc > 1 ? argv[1] : NULL;
  signal(SIGXFSZ, SIG_IGN); /* a file above ulimit -f is an error as a full disk is */
  if (word && (!strcmp(word, "--help") || !strcmp(word, "-h") || !strcmp(word, "help"))) {
    print_help(find(argc > 2 ? argv[2] : NULL));
    return PROG_OK;
  }
  if (word && (!strcmp(word, "--version") || !strcmp(word, "-V"))) {
    printf("sphode %s\n", sph_version());
    return PROG_OK;
  }
  const command *c = find(word);
  if (!c) return no_command(word);
  keep_command(&o, argc, argv);
  int status = parse(c, argc - 1, argv + 1, &o);
  if (status < 0) status = c->run(&o);
  if (fflush(stdout) || ferror(stdout))
    return sph_prog_error(PROG_FAILED, "cannot write to standard output");
  return status;
}
