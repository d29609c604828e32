# SPH_CHECK_LIBRARY(NAME, MODULES, LIBRARY, FUNCTION, HEADER)
#
# A required library by the first of MODULES that pkg-config knows, else by a link test of -lLIBRARY; FUNCTION must be in
# it.  Sets sph_have_NAME, NAME_CFLAGS, NAME_LIBS, NAME_VERSION; what it says goes into the .pc file.
AC_DEFUN([SPH_CHECK_LIBRARY], [
AC_ARG_VAR([$1][_CFLAGS], [C flags for $1, instead of what pkg-config says])
AC_ARG_VAR([$1][_LIBS], [libraries of $1, instead of what pkg-config says])
$1[]_VERSION=unknown sph_module=
for sph_candidate in $2; do
  AS_IF([test "x$sph_module" = x && $PKG_CONFIG --exists "$sph_candidate"], [sph_module=$sph_candidate])
done
AS_IF([test "x$$1[]_LIBS" != x], [sph_libs_private="$sph_libs_private $$1[]_LIBS"],
  [test "x$sph_module" != x], [
    $1[]_CFLAGS=`$PKG_CONFIG --cflags $sph_module`
    $1[]_LIBS=`$PKG_CONFIG --libs $sph_module`
    $1[]_VERSION=`$PKG_CONFIG --modversion $sph_module`
    sph_requires_private="$sph_requires_private$sph_comma$sph_module" sph_comma=", "],
  [$1[]_LIBS=-l$3 sph_libs_private="$sph_libs_private -l$3"])
AC_MSG_CHECKING([for $4 in $$1[]_LIBS])
sph_save_CPPFLAGS=$CPPFLAGS sph_save_LIBS=$LIBS
CPPFLAGS="$CPPFLAGS $$1[]_CFLAGS" LIBS="$$1[]_LIBS $LIBS"
AC_LINK_IFELSE([AC_LANG_PROGRAM([[#include <$5>]], [[return !(void *)$4;]])],
  [sph_have_$1=yes], [sph_have_$1=no])
CPPFLAGS=$sph_save_CPPFLAGS LIBS=$sph_save_LIBS
AC_MSG_RESULT([$sph_have_$1])
AC_SUBST([sph_requires_private])
AC_SUBST([sph_libs_private])
])
