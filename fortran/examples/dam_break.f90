! dam_break -- examples/03_dam_break.c in Fortran: a column of water falls.   ./dam_break [H/dx, default 40]
!
! With two additions: what is read is the library's own memory, and gravity may be a force of your own
! (./dam_break 40 own), which walls do not know of.
module own_gravity
  use sphode
  implicit none
  real(c_double), parameter :: g = 9.81_c_double ! [m/s^2]
contains
  ! Called for each fluid in each evaluation: sph_term%body of sphode/term.h.
  function fall(term, particles) bind(C) result(status)
    type(sph_term), intent(in) :: term
    type(sph_particles), intent(in) :: particles
    integer(c_int) :: status
    real(c_double), pointer :: a(:)
    a => sph_numbers(particles%a(2), particles%n)
    a = a - g
    status = merge(SPH_OK, SPH_ERR_ARGUMENT, c_associated(term%body))
  end function
end module

program dam_break
  use own_gravity
  implicit none
  real(c_double), parameter :: H = 0.6_c_double, rho0 = 1000 ! height of the column [m], [kg/m^3]
  real(c_double) :: dx, c0, t, run
  real(c_double), pointer :: x(:)
  type(c_ptr) :: sim, water, tank
  type(sph_term) :: own
  character(kind=c_char, len=12), target :: name = "own-gravity"//c_null_char
  character(kind=c_char, len=27), target :: method = "erk:bogacki-shampine-4-2-3"//c_null_char
  character(20) :: word
  integer :: across, status

  across = 40
  call get_command_argument(1, word)
  if (word /= "") read (word, *) across
  dx = H/across
  c0 = 20*sqrt(g*H)

  sim = sph_sim_create(sph_sim_def(dim=2, dx=dx)) ! the kernel: wendland-c2, the default
  water = sph_group_box(sim, "water"//c_null_char, [0.0_c_double, 0.0_c_double], [2*H, H], rho0)
  tank = sph_group_walls(sim, "tank"//c_null_char, [0.0_c_double, 0.0_c_double], [5.366_c_double*H, 3*H], rho0)
  call sph_group_set_eos(water, sph_eos_tait(rho0, c0, 7.0_c_double))
  call sph_group_set_boundary(tank, sph_boundary_adami())

  call sph_sim_add_term(sim, sph_term_continuity())
  call sph_sim_add_term(sim, sph_term_pressure())
  call sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02_c_double, 0.0_c_double))
  call sph_sim_add_term(sim, sph_term_delta("antuono"//c_null_char, 0.1_c_double))
  call get_command_argument(2, word)
  if (word == "own") then
    own%name = c_loc(name)
    own%body = c_funloc(fall)
    call sph_sim_add_term(sim, own)
  else
    call sph_sim_add_term(sim, sph_term_gravity([0.0_c_double, -g, 0.0_c_double]))
  end if

  call sph_sim_set_integrator(sim, sph_integrator_def(method=c_loc(method)))
  call sph_sim_add_output(sim, sph_output_hdf5("dam_break"//c_null_char, 0.05_c_double))

  t = 1.2_c_double*sqrt(H/g)
  status = sph_sim_run(sim, t)
  if (status /= SPH_OK) then
    print '(2a)', "dam_break: ", sph_string(sph_sim_error(sim))
    error stop
  end if
  x => sph_numbers(sph_group_read(water, "position"//c_null_char, 0), sph_group_count(water))
  run = (maxval(x) - 2*H)/(2*sqrt(g*H)*t)
  print '(a,f0.4,a,f0.3,a)', "t = ", t, " s: the front has run ", run, " of 2 sqrt(g H) t"
  call sph_sim_free(sim)
  if (run < 0.4 .or. run > 1) error stop "That is too little or too much."
end program
