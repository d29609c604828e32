! neighbors -- examples/02_neighbors.c in Fortran: the neighbours of points that are nearly a square lattice.
program neighbors_of_points
  use sphode
  implicit none
  integer(c_long), parameter :: across = 40, n = across**2
  real(c_double), parameter :: dx = 0.025_c_double, pi = acos(-1.0_c_double) ! spacing [m]: the box is 1 m x 1 m
  real(c_double), target :: x(n), y(n)
  real(c_double) :: shift(2), reach
  integer(c_long) :: i
  integer :: k, seeds(64)
  logical :: good

  seeds = 1
  call random_seed(put=seeds)
  do i = 0, n - 1
    call random_number(shift)
    shift = 0.5 + 0.8*(shift - 0.5)
    x(i + 1) = dx*(real(mod(i, across), c_double) + shift(1))
    y(i + 1) = dx*(real(i/across, c_double) + shift(2))
  end do

  good = .true.
  print '(a)', "  h/dx  mean neighbours  pi (kappa h/dx)^2 - 1"
  do k = 0, 4
    reach = sph_kernel_support(sph_kernel_find("wendland-c2"//c_null_char))*(1.2 + 0.3*k)*dx
    call measure(1.2_c_double + 0.3_c_double*k)
  end do
  if (.not. good) error stop "Neighbours are wrong."
  print '(/,a)', "As many as there should be."

contains

  subroutine measure(h_over_dx)
    real(c_double), intent(in) :: h_over_dx
    type(c_ptr) :: search
    type(sph_error) :: error
    integer(c_long) :: found(200), total, count, i
    real(c_double) :: distance(200), expected, mean
    integer :: j
    logical :: right
    search = sph_neighbors_create(sph_neighbors_def(dim=2, reach=reach, dx=dx, periodic=[1, 1, 0], &
                                                    length=[1.0_c_double, 1.0_c_double, 0.0_c_double]), error)
    right = c_associated(search)
    if (right) right = sph_neighbors_sort(search, 0, n, [c_loc(x), c_loc(y)], error) == SPH_OK
    if (right) right = sph_neighbors_build(search, 0, 0, error) == SPH_OK
    if (.not. right) then
      print '(200a)', (error%text(j), j=1, 200)
      good = .false.
      return
    end if
    total = 0
    do i = 0, n - 1
      count = sph_neighbors_find(search, 0, 0, i, 200_c_long, found, distance)
      total = total + count
      good = good .and. all(distance(:count) < reach)
    end do
    call sph_neighbors_free(search)
    mean = real(total, c_double)/n
    expected = pi*(reach/dx)**2 - 1
    print '(f6.2,2f15.3,f9.2,a)', h_over_dx, mean, expected, 100*(mean/expected - 1), " %"
    good = good .and. abs(mean/expected - 1) < 0.02
  end subroutine
end program
