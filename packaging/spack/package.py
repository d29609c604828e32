# Spack recipe: put it into a repository of yours, packages/sphode/package.py (`spack repo create`).
# packaging/release writes url and checksum of a release.
from spack.package import *


class Sphode(AutotoolsPackage):
    """Smoothed particle hydrodynamics as a system of ordinary differential equations, on SUNDIALS."""

    homepage = "https://sphode.example"
    url = "https://sphode.example/sphode-0.8.0.tar.gz"
    license("BSD-3-Clause", checked_by="the sphode authors")

    version("0.8.0", sha256="0" * 64)

    variant("openmp", default=True, description="Several threads")
    variant("python", default=False, description="Install the Python package")
    variant("live", default=True, description="A page in the browser while a run goes")
    variant("gnuplot", default=True, description="Pictures")

    depends_on("c", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("sundials@6.4.1:7 +ARKODE ~mpi")
    depends_on("suite-sparse")
    depends_on("gsl")
    depends_on("hdf5 ~mpi")
    depends_on("libyaml")
    depends_on("muparser")
    depends_on("expat")
    depends_on("zlib-api")
    depends_on("libmicrohttpd", when="+live")
    depends_on("cmocka", type="test")
    depends_on("gnuplot", type="run", when="+gnuplot")
    with when("+python"):
        extends("python@3.8:")
        depends_on("py-cffi", type="run")
        depends_on("py-numpy", type="run")
        depends_on("py-h5py", type="run")

    def configure_args(self):
        spec = self.spec
        args = [
            f"--with-sundials={spec['sundials'].prefix}",
            f"--with-suitesparse={spec['suite-sparse'].prefix}",
        ]
        args += self.enable_or_disable("openmp")
        args += self.enable_or_disable("python")
        args += self.enable_or_disable("live")
        if spec.satisfies("+python"):
            args += [f"PYTHON={spec['python'].command.path}", f"pythondir={python_purelib}"]
        return args
