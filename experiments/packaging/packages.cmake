# Debian packages by CPack, from a generic build: `bash experiments/packaging/packages.sh`. Each component that is installed
# is a package of its own.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hagfish)
set(CPACK_PACKAGE_CONTACT "The hagfish authors <hagfish@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Simulator of knotting hagfish")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program python development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME hagfish)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Ties, slides, audits and replays knots of a slender body.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libjs-three, node-d3")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "python3-h5py, python3-matplotlib, libgl1-mesa-dri, ffmpeg")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-hagfish)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The simulator of knotting hagfish in Python.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS # hagfish.design runs the program
  "hagfish (= ${PROJECT_VERSION}), python3 (>= 3.11), python3 (<< 3.12), python3-numpy, python3-h5py")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-xarray, python3-h5netcdf")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libhagfish-dev)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Libraries and headers of the simulator of knotting hagfish.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "pkg-config, libeigen3-dev, libhdf5-dev, libfmt-dev, coinor-libipopt-dev, libmujoco-dev, libegl-dev, libpng-dev")
include(CPack)
