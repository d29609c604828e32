! kernel -- examples/01_kernel.c in Fortran: a table of W and dW/dr, and the integral that must be 1.
program kernel_table
  use sphode
  implicit none
  real(c_double), parameter :: h = 0.02_c_double ! [m]; any
  type(c_ptr) :: kernel
  integer(c_int) :: k, dim
  logical :: good

  good = .true.
  k = 0
  do
    kernel = sph_kernel_get(k)
    if (.not. c_associated(kernel)) exit
    do dim = 1, 3
      call show(dim)
    end do
    k = k + 1
  end do
  if (.not. good .or. k < 8) error stop "An integral is not 1."
  print '(/,a)', "All integrals are 1."

contains

  subroutine show(dim)
    integer(c_int), intent(in) :: dim
    real(c_double) :: total, h_over_dx
    integer :: q
    total = integral(dim)
    print '(/,a,a,i0,a,a)', sph_string(sph_kernel_name(kernel)), " in ", dim, "D: ", sph_string(sph_kernel_formula(kernel, dim))
    h_over_dx = sph_kernel_h_over_dx(kernel)
    print '(a,es9.1,a,g0.3,a,i0,a)', "  integral 1 ", total - 1, "; at h/dx ", h_over_dx, " ", &
      nint(sph_kernel_neighbors(kernel, dim, h_over_dx)), " neighbors"
    do q = 0, int(4*sph_kernel_support(kernel))
      print '(f8.2,2f15.10)', 0.25*q, sph_kernel_w(kernel, dim, 0.25*q*h, h)*h**dim, &
        sph_kernel_dwdr(kernel, dim, 0.25*q*h, h)*h**(dim + 1)
    end do
    good = good .and. abs(total - 1) < 1e-12_c_double
  end subroutine

  ! Simpson's rule: no step crosses a knot, all of which are multiples of h.
  function integral(dim) result(total)
    integer(c_int), intent(in) :: dim
    real(c_double) :: total, r, edge, area, weight
    integer :: i, steps
    steps = 1000*ceiling(sph_kernel_support(kernel))
    edge = sph_kernel_support(kernel)*h*(1 - 1e-15_c_double) ! inside: the Gaussian jumps there
    total = 0
    do i = 0, steps
      r = min(i*h/1000, edge)
      area = merge(2.0_c_double, 2*acos(-1.0_c_double)*(dim - 1)*r**(dim - 1), dim == 1)
      weight = merge(1, merge(4, 2, mod(i, 2) == 1), i == 0 .or. i == steps)
      total = total + weight*h/3000*area*sph_kernel_w(kernel, dim, r, h)
    end do
  end function
end program
