#!/usr/bin/env bash
# Free surfaces as cases: standing wave, rotating square, dam breaks with impact.  Coarse ones here, with bars that a coarse run
# meets; SPHODE_TEST_LONG=1: those of the case files, too.
source "$SRCDIR/tests/tap.sh"

meets() { # what, case, options...: the run meets its bars
  local what=$1 case=$2 status
  shift 2
  "$sphode" run "$SRCDIR/cases/$case.yml" -o run -q --force "$@" >log 2>&1
  status=$?
  count=$((count + 1))
  sed -n '/"comparisons"/,$s/^ *{*"\(name\|value\|bar\|note\)": /# \1 /p' run/summary.json
  if [[ $status == 0 ]]; then
    echo "ok $count - $what"
  else
    sed 's/^/# /' log
    echo "not ok $count - $what"
  fi
}

meets "standing wave: period and damping, H/dx = 20" standing-wave-2d --set parameters.dx=H/20
meets "rotating square: pressure in the centre from none, n = 25" rotating-square-2d --set parameters.n=25 \
  --set parameters.start=0 --set compare.1.bar=0.025
meets "rotating square: exact pressure, n = 25" rotating-square-2d --set parameters.n=25 --set compare.0.bar=0.06
meets "dam break with impact: plateau, arrival, H/dx = 20" dam-break-2d-impact --set parameters.dx=H/20 \
  --set compare.0.bar=0.22
early=(--set "run.end=2.8*T" --set "compare.0.window=[2.4, 2.8]" --set compare.0.bar=1)
meets "dam break in 3D: arrival, H/dx = 10" dam-break-3d-lobovsky --set parameters.n=10 "${early[@]}" \
  --set compare.1.bar=0.1
if [[ ${SPHODE_TEST_LONG:-} ]]; then
  meets "standing wave, H/dx = 40" standing-wave-2d
  meets "rotating square, n = 50" rotating-square-2d
  meets "rotating square from no pressure, n = 50" rotating-square-2d --set parameters.start=0
  meets "dam break with impact, H/dx = 80" dam-break-2d-impact --set compare.0.bar=0.17
  meets "dam break in 3D, H/dx = 20" dam-break-3d-lobovsky --set parameters.n=20 --set compare.0.bar=0.3
fi
echo "1..$count"
