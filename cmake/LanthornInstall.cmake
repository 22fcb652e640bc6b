# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
# What cmake --install puts in place: program, library, headers, CMake package, pkg-config file, man pages, completion.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lanthorn)
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY ${CMAKE_INSTALL_FULL_BINDIR} OUTPUT_VARIABLE bin_to_lib)
set_target_properties(lanthorn_program PROPERTIES INSTALL_RPATH $ORIGIN/${bin_to_lib}/lanthorn)
install(TARGETS lanthorn_program)
install(TARGETS lanthorn_openimageio LIBRARY DESTINATION ${LANTHORN_INSTALL_MODULE_DIR})
if(LANTHORN_BUILD_MPI)
  install(TARGETS lanthorn_mpi LIBRARY DESTINATION ${LANTHORN_INSTALL_MODULE_DIR})
endif()
if(LANTHORN_BUILD_VIEWER)
  install(TARGETS lanthorn_window LIBRARY DESTINATION ${LANTHORN_INSTALL_MODULE_DIR})
endif()
install(TARGETS lanthorn EXPORT lanthorn)
install(DIRECTORY include/lanthorn DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN *.h)
install(FILES README.md LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
# The program has written these (apps/lanthorn/CMakeLists.txt).
install(DIRECTORY ${CMAKE_BINARY_DIR}/share/man/ DESTINATION ${CMAKE_INSTALL_MANDIR})
install(DIRECTORY ${CMAKE_BINARY_DIR}/share/bash-completion DESTINATION ${CMAKE_INSTALL_DATADIR})

install(EXPORT lanthorn NAMESPACE lanthorn:: FILE lanthorn-targets.cmake DESTINATION ${package_dir})
configure_file(cmake/lanthorn-config.cmake.in lanthorn-config.cmake @ONLY)
write_basic_package_version_file(lanthorn-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/lanthorn-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/lanthorn-config-version.cmake
        DESTINATION ${package_dir})

# pkg-config knows neither embree nor meshoptimizer, so the file names all libraries by their paths on this machine: shared
# ones by the link without a version, so that it holds after an update.
set(linked_files)
foreach(library IN LISTS LANTHORN_LINKED)
  set(file $<TARGET_LINKER_FILE:${library}>)
  list(APPEND linked_files $<IF:$<STREQUAL:$<TARGET_PROPERTY:${library},TYPE>,SHARED_LIBRARY>,$<PATH:REPLACE_EXTENSION,${file},.so>,${file}>)
endforeach()
if(LANTHORN_BUILD_VIEWER)
  list(APPEND linked_files -lepoxy)
endif()
list(JOIN linked_files " " linked_files)
# Relative to the file itself, so that it holds for any --prefix.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
           OUTPUT_VARIABLE pkgconfig_to_prefix)
configure_file(cmake/lanthorn.pc.in lanthorn.pc.in @ONLY)
file(GENERATE OUTPUT lanthorn.pc INPUT ${CMAKE_CURRENT_BINARY_DIR}/lanthorn.pc.in)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/lanthorn.pc DESTINATION ${pkgconfig_dir})
