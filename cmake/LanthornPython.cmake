# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
# Whether the Python module is built, and for which Python: the system's unless -DPython3_EXECUTABLE names another one, as
# its packages (numpy) are what Debian installs. LANTHORN_BUILD_PYTHON is ON by default where pybind11 and the headers are.
if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
find_package(pybind11 2.10 QUIET CONFIG)
set(python_found OFF)
if(Python3_FOUND AND pybind11_FOUND)
  set(python_found ON)
endif()
option(LANTHORN_WHEEL "Install the Python module with all that it loads in one folder (pip install .)" OFF)
set(python_wanted ${python_found})
if(LANTHORN_SANITIZE)
  set(python_wanted OFF)  # Python itself would have to load the sanitizer first
endif()
option(LANTHORN_BUILD_PYTHON "Build the Python module lanthorn" ${python_wanted})
if(LANTHORN_BUILD_PYTHON AND NOT python_found)
  message(FATAL_ERROR "LANTHORN_BUILD_PYTHON needs pybind11 and Python's headers: scripts/install-packages build")
endif()
if(LANTHORN_BUILD_PYTHON)
  message(STATUS "Python module: for ${Python3_EXECUTABLE} (${Python3_VERSION})")
else()
  message(STATUS "Python module: not built (LANTHORN_BUILD_PYTHON=${LANTHORN_BUILD_PYTHON}; pybind11 and Python's headers found: ${python_found})")
endif()
# Where Debian looks, below /usr and below /usr/local.
set(LANTHORN_INSTALL_PYTHON_DIR lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/dist-packages CACHE STRING "Folder of Python packages below the prefix")
