# SPH_CHECK_SUNDIALS
#
# SUNDIALS 6.4.1 to 7.x, with or without MPI in it, with 32- or 64-bit indices.  Its packages bring no pkg-config file;
# what it is stands in sundials/sundials_config.h, which never includes mpi.h.
# Sets sph_have_sundials (yes, no), sph_missing, SUNDIALS_VERSION, SUNDIALS_CPPFLAGS, SUNDIALS_LIBS, SUNDIALS_DESCRIPTION.
AC_DEFUN([SPH_CHECK_SUNDIALS], [
AC_ARG_WITH([sundials],
  [AS_HELP_STRING([--with-sundials=PREFIX], [where SUNDIALS is installed])],
  [], [with_sundials=yes])
sph_have_sundials=no SUNDIALS_CPPFLAGS= SUNDIALS_LIBS= SUNDIALS_VERSION= SUNDIALS_DESCRIPTION= sph_mpi_libs= sph_rpath=
AS_CASE([$with_sundials],
  [no], [AC_MSG_ERROR([sphode cannot be built without SUNDIALS])],
  [yes|''], [],
  [AS_IF([test ! -r "$with_sundials/include/sundials/sundials_config.h"],
     [AC_MSG_ERROR([--with-sundials=$with_sundials: no include/sundials/sundials_config.h in it])])
   SUNDIALS_CPPFLAGS="-I$with_sundials/include"
   for sph_lib in lib lib64; do
     AS_IF([test -d "$with_sundials/$sph_lib"],
       [SUNDIALS_LIBS="$SUNDIALS_LIBS -L$with_sundials/$sph_lib -R$with_sundials/$sph_lib"
        sph_rpath="$sph_rpath -L$with_sundials/$sph_lib -Wl,-rpath,$with_sundials/$sph_lib"])
   done])
sph_save_CPPFLAGS=$CPPFLAGS sph_save_LIBS=$LIBS
CPPFLAGS="$CPPFLAGS $SUNDIALS_CPPFLAGS"
AC_CHECK_HEADER([sundials/sundials_config.h], [_SPH_SUNDIALS_INSPECT])
AS_IF([test "x$SUNDIALS_VERSION" != x], [_SPH_SUNDIALS_LINK])
AS_IF([test $sph_have_sundials = yes], [_SPH_SUNDIALS_CVODE])
CPPFLAGS=$sph_save_CPPFLAGS LIBS=$sph_save_LIBS
AC_SUBST([SUNDIALS_CPPFLAGS])
AC_SUBST([SUNDIALS_PC_LIBS], ["`AS_ECHO(["$SUNDIALS_LIBS"]) | sed 's/ -R/ -Wl,-rpath,/g'`"])
AC_SUBST([SUNDIALS_LIBS])
AC_SUBST([SUNDIALS_VERSION])
])

# Version, width of an index, MPI: from sundials_config.h alone.
AC_DEFUN([_SPH_SUNDIALS_INSPECT], [
m4_foreach_w([part], [MAJOR MINOR PATCH],
  [AC_COMPUTE_INT([sph_sundials_]part, [SUNDIALS_VERSION_]part, [@%:@include <sundials/sundials_config.h>],
     [sph_sundials_]part[=0])
])
AC_COMPUTE_INT([sph_sundials_bits], [8 * sizeof(SUNDIALS_INDEX_TYPE)],
  [@%:@include <stdint.h>
@%:@include <sundials/sundials_config.h>], [sph_sundials_bits=0])
AC_COMPUTE_INT([sph_sundials_mpi], [SUNDIALS_MPI_ENABLED + 0], [@%:@include <sundials/sundials_config.h>],
  [sph_sundials_mpi=0])
sph_version=`expr $sph_sundials_MAJOR \* 10000 + $sph_sundials_MINOR \* 100 + $sph_sundials_PATCH`
AS_IF([test $sph_version -ge 60401],
  [SUNDIALS_VERSION=$sph_sundials_MAJOR.$sph_sundials_MINOR.$sph_sundials_PATCH],
  [AC_MSG_WARN([SUNDIALS $sph_sundials_MAJOR.$sph_sundials_MINOR.$sph_sundials_PATCH is older than 6.4.1])])
])

# From 7.0 on, a SUNDIALS built with MPI includes mpi.h in every header and needs libmpi for SUN_COMM_NULL.
AC_DEFUN([_SPH_SUNDIALS_LINK], [
sph_sundials_core=
AS_IF([test $sph_sundials_MAJOR -ge 7], [sph_sundials_core=-lsundials_core
  AS_IF([test $sph_sundials_mpi = 1], [_SPH_SUNDIALS_MPI])])
SUNDIALS_LIBS="$SUNDIALS_LIBS -lsundials_arkode -lsundials_nvecserial $sph_sundials_core $sph_mpi_libs"
LIBS="$sph_rpath -lsundials_arkode -lsundials_nvecserial $sph_sundials_core $sph_mpi_libs $LIBS -lm"
CPPFLAGS="$sph_save_CPPFLAGS $SUNDIALS_CPPFLAGS"
AC_MSG_CHECKING([whether SUNDIALS $SUNDIALS_VERSION links])
AC_LINK_IFELSE(
  [AC_LANG_PROGRAM([[#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>
#if SUNDIALS_VERSION_MAJOR < 7
#define SUN_COMM_NULL NULL
#endif]], [[SUNContext context; void *memory = ERKStepCreate;
    return SUNContext_Create(SUN_COMM_NULL, &context) || !memory;]])],
  [sph_have_sundials=yes], [SUNDIALS_VERSION=])
AC_MSG_RESULT([$sph_have_sundials])
AS_IF([test $sph_have_sundials = yes], [
  AC_CHECK_HEADERS([arkode/arkode_sprkstep.h arkode/arkode_lsrkstep.h arkode/arkode_splittingstep.h], [], [],
    [@%:@include <sundials/sundials_types.h>])
  AC_CHECK_FUNCS([ARKodeEvolve ARKStepSetRelaxFn ERKStepSetRelaxFn ARKodeCreateMRIStepInnerStepper])
  AS_IF([test $sph_version -ge 70200], [SUNDIALS_INTEGRATORS="erk imex mri sprk lsrk, relaxation"],
    [test $sph_version -ge 60600],
    [SUNDIALS_INTEGRATORS="erk imex mri sprk, relaxation (no lsrk, no error control of mri: 7.2 and later)"],
    [SUNDIALS_INTEGRATORS="erk imex mri (no sprk, no relaxation: 6.6; no lsrk, no error control of mri: 7.2)"])
  SUNDIALS_DESCRIPTION="$SUNDIALS_VERSION ($sph_sundials_bits-bit indices"
  AS_IF([test $sph_sundials_mpi = 1],
    [SUNDIALS_DESCRIPTION="$SUNDIALS_DESCRIPTION, MPI in it)"], [SUNDIALS_DESCRIPTION="$SUNDIALS_DESCRIPTION)"])])
])

# The flags of the MPI that SUNDIALS was built with: CC stays the plain compiler.
AC_DEFUN([_SPH_SUNDIALS_MPI], [
AC_ARG_VAR([MPICC], [MPI compiler, asked for flags if SUNDIALS has MPI in it])
AC_PATH_PROGS([MPICC], [mpicc mpicc.openmpi mpicc.mpich])
AS_IF([test "x$MPICC" != x],
  [sph_mpi_flags=`$MPICC --showme:compile 2>/dev/null` &&
   sph_mpi_libs=`$MPICC --showme:link 2>/dev/null` || {
     sph_mpi_flags=`$MPICC -compile_info | sed 's/^[[^ ]]* //'`
     sph_mpi_libs=`$MPICC -link_info | sed 's/^[[^ ]]* //'`
   }
   SUNDIALS_CPPFLAGS="$SUNDIALS_CPPFLAGS $sph_mpi_flags"],
  [AC_MSG_WARN([SUNDIALS $SUNDIALS_VERSION has MPI in it and no mpicc was found])])
])

# CVODE with GMRES: an example drives it, the library does not need it.  Sets sph_have_cvode, CVODE_LIBS.
AC_DEFUN([_SPH_SUNDIALS_CVODE], [
sph_have_cvode=no CVODE_LIBS="-lsundials_cvode -lsundials_sunlinsolspgmr"
AC_MSG_CHECKING([whether SUNDIALS has CVODE])
LIBS="$sph_rpath $CVODE_LIBS $LIBS"
AC_LINK_IFELSE(
  [AC_LANG_PROGRAM([[#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_spgmr.h>]], [[void *cvode = CVodeCreate, *solver = SUNLinSol_SPGMR;
    return !cvode || !solver;]])],
  [sph_have_cvode=yes], [CVODE_LIBS=])
AC_MSG_RESULT([$sph_have_cvode])
AC_SUBST([CVODE_LIBS])
])
