# SPH_CHECK_SUITESPARSE
#
# KLU and CHOLMOD of SuiteSparse 5 or later.  Version 5 brings no pkg-config files, so headers and a link test.
# Sets sph_have_suitesparse (yes, no), SUITESPARSE_VERSION, SUITESPARSE_CPPFLAGS, SUITESPARSE_LIBS.
AC_DEFUN([SPH_CHECK_SUITESPARSE], [
AC_ARG_WITH([suitesparse],
  [AS_HELP_STRING([--with-suitesparse=PREFIX], [where SuiteSparse is installed])],
  [], [with_suitesparse=yes])
sph_have_suitesparse=no SUITESPARSE_CPPFLAGS= SUITESPARSE_LIBS= SUITESPARSE_VERSION= sph_rpath=
AS_CASE([$with_suitesparse], [yes|no|''], [],
  [SUITESPARSE_CPPFLAGS="-I$with_suitesparse/include"
   SUITESPARSE_LIBS="-L$with_suitesparse/lib -R$with_suitesparse/lib"
   sph_rpath="-L$with_suitesparse/lib -Wl,-rpath,$with_suitesparse/lib"])
sph_save_CPPFLAGS=$CPPFLAGS sph_save_LIBS=$LIBS
LIBS="$sph_rpath -lklu -lcholmod -lsuitesparseconfig $LIBS"
AC_MSG_CHECKING([for KLU and CHOLMOD])
for sph_dir in '' /suitesparse; do
  for sph_root in "$with_suitesparse/include" /usr/include /usr/local/include /opt/homebrew/include; do
    AS_IF([test $sph_have_suitesparse = no && test -r "$sph_root$sph_dir/klu.h"], [
      CPPFLAGS="$sph_save_CPPFLAGS -I$sph_root$sph_dir"
      AC_LINK_IFELSE(
        [AC_LANG_PROGRAM([[#include <klu.h>
#include <cholmod.h>]], [[klu_common klu; cholmod_common cholmod; return !klu_defaults(&klu) || !cholmod_start(&cholmod);]])],
        [sph_have_suitesparse=yes
         AS_CASE([$sph_root$sph_dir], [/usr/include|/usr/local/include], [],
           [SUITESPARSE_CPPFLAGS="-I$sph_root$sph_dir"])])])
  done
done
AC_MSG_RESULT([$sph_have_suitesparse])
AS_IF([test $sph_have_suitesparse = yes], [
  m4_foreach_w([part], [MAIN SUB SUBSUB],
    [AC_COMPUTE_INT([sph_suitesparse_]part, [SUITESPARSE_]part[_VERSION], [@%:@include <SuiteSparse_config.h>],
       [sph_suitesparse_]part[=0])
])
  SUITESPARSE_VERSION=$sph_suitesparse_MAIN.$sph_suitesparse_SUB.$sph_suitesparse_SUBSUB
  SUITESPARSE_LIBS="$SUITESPARSE_LIBS -lklu -lcholmod -lsuitesparseconfig"
  sph_libs_private="$sph_libs_private $sph_rpath -lklu -lcholmod -lsuitesparseconfig"])
CPPFLAGS=$sph_save_CPPFLAGS LIBS=$sph_save_LIBS
AC_SUBST([SUITESPARSE_CPPFLAGS])
AC_SUBST([SUITESPARSE_LIBS])
])
