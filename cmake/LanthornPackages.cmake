# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
# Debian packages by cpack: lanthorn, lanthorn-mpi, liblanthorn-dev, lanthorn-doc and python3-lanthorn. The first can have
# the library for several instruction sets, of which the dynamic linker takes the one that fits (glibc-hwcaps).
set(LANTHORN_PACKAGE_LIBRARIES "" CACHE STRING "Build folders whose library goes into the package lanthorn, too")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lanthorn)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "renderer for caustics, glass, water and fog")
set(CPACK_PACKAGE_VENDOR "The Lanthorn authors")
set(CPACK_PACKAGE_CONTACT "The Lanthorn authors <maintainers@users.noreply.h-seed-af79472f.example>")
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};lanthorn;ALL;/")
foreach(folder IN LISTS LANTHORN_PACKAGE_LIBRARIES)
  list(APPEND CPACK_INSTALL_CMAKE_PROJECTS "${folder};lanthorn;library;/")
endforeach()
set(CPACK_COMPONENTS_LIBRARY library)  # of these folders; without it, they are installed beside all packages, into none
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/DebianFiles.cmake)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR}/lib)  # the Python module needs our own library
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

# lanthorn_package(GROUP NAME SECTION TEXT): the variables of one package.
macro(lanthorn_package group name section text)
  string(TOUPPER ${group} key)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${key}_DESCRIPTION "${text}")
endmacro()

lanthorn_package(program lanthorn graphics
"Lanthorn traces photons and caches them, combines them with path tracing
under one set of weights, and says how far a picture is from the truth. It
reads pbrt, glTF and OBJ. This package has the program, its library for
several instruction sets, and scenes.")
file(WRITE ${CMAKE_BINARY_DIR}/triggers "activate-noawait ldconfig\n")
# CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS would name the library once for each instruction set, which lintian refuses.
file(WRITE ${CMAKE_BINARY_DIR}/shlibs "liblanthorn ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} lanthorn (= ${PROJECT_VERSION})\n")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA "${CMAKE_BINARY_DIR}/triggers;${CMAKE_BINARY_DIR}/shlibs")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "lanthorn-mpi, lanthorn-doc")
lanthorn_package(mpi lanthorn-mpi graphics
"With this module, the processes that mpirun starts share the passes of one
picture.")
set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "lanthorn (= ${PROJECT_VERSION}), openmpi-bin")
lanthorn_package(development liblanthorn-dev libdevel
"Headers of the C++20 library, its CMake package and its pkg-config file.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "lanthorn (= ${PROJECT_VERSION}), libglm-dev")
lanthorn_package(doc lanthorn-doc doc
"Methods and where they come from, measurements, scenes and formats.")
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOC_PACKAGE_SHLIBDEPS OFF)

set(packages program mpi development doc)
if(LANTHORN_BUILD_PYTHON)
  list(APPEND packages python)
  lanthorn_package(python python3-lanthorn python
"Scenes, renders, layers and photons as numpy arrays.")
  file(WRITE ${CMAKE_BINARY_DIR}/prerm "#!/bin/sh
set -e
# What Python has compiled when root has imported the module.
rm -rf /usr/${LANTHORN_INSTALL_PYTHON_DIR}/lanthorn/__pycache__
")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/prerm)
  # Built for one version of Python.
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "lanthorn (= ${PROJECT_VERSION}), python3-numpy, python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}), python3 (<< ${Python3_VERSION_MAJOR}.${next_minor}~)")
endif()

include(CPack)
foreach(group IN LISTS packages)
  cpack_add_component_group(${group})
  cpack_add_component(${group} GROUP ${group})
endforeach()
cpack_add_component(library GROUP program)
