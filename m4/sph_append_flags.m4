# SPH_APPEND_FLAGS(VARIABLE, FLAGS): appends to VARIABLE each of FLAGS that the C compiler takes.
AC_DEFUN([SPH_APPEND_FLAGS], [
AC_SUBST([$1])
for sph_flag in $2; do
  AC_MSG_CHECKING([whether $CC takes $sph_flag])
  sph_save_CFLAGS=$CFLAGS
  CFLAGS="$CFLAGS -Werror $sph_flag"
  AC_COMPILE_IFELSE([AC_LANG_PROGRAM], [sph_taken=yes AS_VAR_APPEND([$1], [" $sph_flag"])], [sph_taken=no])
  CFLAGS=$sph_save_CFLAGS
  AC_MSG_RESULT([$sph_taken])
done
])

# SPH_CHECK_ISA(SUFFIX, FLAGS): is that instruction set asked for, and can the compiler make loops for it here?
# Sets sph_have_SUFFIX, the conditional and the macro SPH_HAVE_SUFFIX (upper case), and substitutes SUFFIX_CFLAGS.
AC_DEFUN([SPH_CHECK_ISA], [
AC_MSG_CHECKING([for instruction set $1])
sph_have_$1=no
AS_CASE([`AS_ECHO([",$enable_instruction_sets,"]) | tr - _`],
  [*,all,*|*,yes,*|*,$1,*], [AS_CASE([$host_cpu], [x86_64|amd64], [
    sph_save_CFLAGS=$CFLAGS
    CFLAGS="$CFLAGS -Werror $2"
    AC_COMPILE_IFELSE([AC_LANG_PROGRAM([], [[return !__builtin_cpu_supports("sse4.2");]])], [sph_have_$1=yes])
    CFLAGS=$sph_save_CFLAGS])])
AC_MSG_RESULT([$sph_have_$1])
AM_CONDITIONAL(m4_toupper([SPH_HAVE_$1]), [test $sph_have_$1 = yes])
AS_IF([test $sph_have_$1 = yes], [
  AC_DEFINE(m4_toupper([SPH_HAVE_$1]), [1], [The pair loops are built for $1.])
  sph_isas="$sph_isas $1"])
AC_SUBST($1[_CFLAGS], ["$2"])
])
