# SPH_CHECK_PETSC
#
# PETSc's time steppers, which an example drives; with the flags of the MPI that it was built with.
# Sets sph_have_petsc (yes, no), PETSC_CPPFLAGS (for headers that are not ours: -isystem), PETSC_LIBS, PETSC_VERSION.
AC_DEFUN([SPH_CHECK_PETSC], [
AC_ARG_WITH([petsc], [AS_HELP_STRING([--without-petsc], [leave out the example that drives PETSc])], [], [with_petsc=yes])
sph_have_petsc=no PETSC_CPPFLAGS= PETSC_LIBS= PETSC_VERSION=
AS_IF([test "x$with_petsc" != xno && $PKG_CONFIG --exists PETSc 2>/dev/null], [
  AC_ARG_VAR([MPICC], [MPI compiler, asked for flags])
  AC_PATH_PROGS([MPICC], [mpicc mpicc.openmpi mpicc.mpich])
  PETSC_CPPFLAGS=`$PKG_CONFIG --cflags-only-I PETSc`
  PETSC_LIBS=`$PKG_CONFIG --libs PETSc`
  AS_IF([test "x$MPICC" != x],
    [PETSC_CPPFLAGS="$PETSC_CPPFLAGS `$MPICC --showme:compile 2>/dev/null || $MPICC -compile_info | sed 's/^[[^ ]]* //'`"
     PETSC_LIBS="$PETSC_LIBS `$MPICC --showme:link 2>/dev/null || $MPICC -link_info | sed 's/^[[^ ]]* //'`"])
  PETSC_CPPFLAGS=`AS_ECHO([" $PETSC_CPPFLAGS"]) | sed 's/ -I/ -isystem /g'`
  AC_MSG_CHECKING([whether PETSc links])
  sph_save_CPPFLAGS=$CPPFLAGS sph_save_LIBS=$LIBS
  CPPFLAGS="$CPPFLAGS $PETSC_CPPFLAGS" LIBS="$PETSC_LIBS $LIBS"
  AC_LINK_IFELSE(
    [AC_LANG_PROGRAM([[#include <petscts.h>
#if defined(PETSC_USE_COMPLEX) || !defined(PETSC_USE_REAL_DOUBLE)
#error doubles are wanted
#endif]], [[TS ts; return PetscInitializeNoArguments() || TSCreate(PETSC_COMM_SELF, &ts);]])],
    [sph_have_petsc=yes PETSC_VERSION=`$PKG_CONFIG --modversion PETSc`], [PETSC_CPPFLAGS= PETSC_LIBS=])
  AC_MSG_RESULT([$sph_have_petsc])
  CPPFLAGS=$sph_save_CPPFLAGS LIBS=$sph_save_LIBS
])
AC_SUBST([PETSC_CPPFLAGS])
AC_SUBST([PETSC_LIBS])
])
