# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
# What cmake --install puts in place, by components, of which LanthornPackages.cmake makes packages.
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lanthorn)
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# All paths are relative to the file that asks, so that the folder can be moved. The second one is for a library in
# glibc-hwcaps/x86-64-v3.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY ${CMAKE_INSTALL_FULL_BINDIR} OUTPUT_VARIABLE bin_to_lib)
set_target_properties(lanthorn_program PROPERTIES INSTALL_RPATH "$ORIGIN/${bin_to_lib};$ORIGIN/${bin_to_lib}/lanthorn")
set_target_properties(lanthorn PROPERTIES INSTALL_RPATH "$ORIGIN/lanthorn;$ORIGIN/../../lanthorn")
if(LANTHORN_WHEEL)  # in one folder with its modules, and without links, which wheels do not have
  set_target_properties(lanthorn PROPERTIES INSTALL_RPATH $ORIGIN VERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
endif()

install(TARGETS lanthorn_program)
install(TARGETS lanthorn EXPORT lanthorn LIBRARY COMPONENT library NAMELINK_COMPONENT development)
install(TARGETS lanthorn_openimageio LIBRARY DESTINATION ${LANTHORN_INSTALL_MODULE_DIR})
if(LANTHORN_BUILD_MPI)
  install(TARGETS lanthorn_mpi LIBRARY DESTINATION ${LANTHORN_INSTALL_MODULE_DIR} COMPONENT mpi)
endif()
if(LANTHORN_BUILD_VIEWER)
  install(TARGETS lanthorn_window LIBRARY DESTINATION ${LANTHORN_INSTALL_MODULE_DIR})
  install(FILES share/lanthorn.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
  install(FILES share/lanthorn.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
  install(FILES share/lanthorn-mime.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages RENAME lanthorn.xml)
endif()
install(FILES README.md LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
# The program has written these (apps/lanthorn/CMakeLists.txt).
install(DIRECTORY ${CMAKE_BINARY_DIR}/share/man/ DESTINATION ${CMAKE_INSTALL_MANDIR})
install(DIRECTORY ${CMAKE_BINARY_DIR}/share/bash-completion DESTINATION ${CMAKE_INSTALL_DATADIR})
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/lanthorn
        PATTERN *.py EXCLUDE PATTERN make-* EXCLUDE)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc PATTERN make-* EXCLUDE)

install(DIRECTORY include/lanthorn DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN *.h)
install(EXPORT lanthorn NAMESPACE lanthorn:: FILE lanthorn-targets.cmake DESTINATION ${package_dir} COMPONENT development)
configure_file(cmake/lanthorn-config.cmake.in lanthorn-config.cmake @ONLY)
write_basic_package_version_file(lanthorn-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/lanthorn-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/lanthorn-config-version.cmake
        DESTINATION ${package_dir} COMPONENT development)
# Relative to the file itself, so that it holds for any --prefix.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
           OUTPUT_VARIABLE pkgconfig_to_prefix)
configure_file(cmake/lanthorn.pc.in lanthorn.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/lanthorn.pc DESTINATION ${pkgconfig_dir} COMPONENT development)
