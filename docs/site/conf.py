# The manual as a site: `make site`.  The sources are the files of the repository, as they are.
import os
import re

project = 'sphode'
copyright = 'the authors of sphode'
root = os.path.abspath(os.path.join(os.path.dirname(__file__), '..', '..'))
with open(os.path.join(root, 'configure.ac')) as file:
    release = version = re.search(r'AC_INIT\(\[sphode\], *\[([^]]+)\]', file.read()).group(1)

extensions = ['myst_parser', 'breathe']
root_doc = 'docs/site/index'
include_patterns = ['README.md', 'CONTRIBUTING.md', 'NEWS.md', 'docs/**', 'examples/README.md', 'packaging/README.md']
exclude_patterns = ['docs/site/*.py']
source_suffix = {'.md': 'markdown'}

myst_heading_anchors = 3
suppress_warnings = ['myst.header']  # theory.md steps from one level to the next but one

breathe_projects = {'sphode': os.environ.get('SPHODE_DOXYGEN_XML', 'xml')}
breathe_default_project = 'sphode'
breathe_domain_by_extension = {'h': 'c'}
breathe_show_include = False

html_theme = 'sphinx_rtd_theme'
html_theme_options = {'navigation_depth': 3}
html_show_sphinx = False
html_show_sourcelink = False
html_static_path = ['site.css']
html_css_files = ['site.css']
