# Homebrew formula: put it into a tap of yours (`brew tap-new you/sphode`), Formula/sphode.rb.
# packaging/release writes url and checksum of a release.
class Sphode < Formula
  desc "Smoothed particle hydrodynamics as a system of ordinary differential equations"
  homepage "https://sphode.example"
  url "https://sphode.example/sphode-0.8.0.tar.gz"
  sha256 "0000000000000000000000000000000000000000000000000000000000000000"
  license "BSD-3-Clause"

  depends_on "pkgconf" => :build
  depends_on "gnuplot"
  depends_on "gsl"
  depends_on "hdf5"
  depends_on "libmicrohttpd"
  depends_on "libyaml"
  depends_on "muparser"
  depends_on "suite-sparse"
  depends_on "sundials"

  uses_from_macos "expat"
  uses_from_macos "zlib"

  on_macos do
    depends_on "libomp"
  end

  def install
    args = ["--with-sundials=#{Formula["sundials"].opt_prefix}", "--with-suitesparse=#{Formula["suite-sparse"].opt_prefix}",
            "--disable-python"]
    if OS.mac?
      omp = Formula["libomp"].opt_prefix
      ENV.append "CPPFLAGS", "-I#{omp}/include"
      ENV.append "LDFLAGS", "-L#{omp}/lib -lomp"
      args << "ac_cv_prog_c_openmp=-Xpreprocessor -fopenmp"
    end
    system "./configure", *args, *std_configure_args
    system "make"
    system "make", "install"
  end

  test do
    cp pkgshare/"cases/sod-1d.yml", testpath
    system bin/"sphode", "run", "-q", "--set", "spacing=0.01", "-o", "out", "sod-1d.yml"
    assert_path_exists testpath/"out/summary.json"
  end
end
