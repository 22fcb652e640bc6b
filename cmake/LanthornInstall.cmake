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

# What cmake --install copies from the build folder; scripts/build builds it.
add_custom_target(installed_files)
add_dependencies(installed_files lanthorn_program lanthorn lanthorn_openimageio)
foreach(target IN ITEMS lanthorn_mpi lanthorn_window lanthorn_python blender_addon)
  if(TARGET ${target})
    add_dependencies(installed_files ${target})
  endif()
endforeach()

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
export(EXPORT lanthorn NAMESPACE lanthorn:: FILE lanthorn-targets.cmake)  # for find_package in the build folder
configure_file(cmake/lanthorn-config.cmake.in lanthorn-config.cmake @ONLY)
write_basic_package_version_file(lanthorn-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/lanthorn-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/lanthorn-config-version.cmake
        DESTINATION ${package_dir} COMPONENT development)
# For pkg-config in the build folder, whose headers are those of the sources.
set(pc_prefix ${CMAKE_BINARY_DIR})
set(pc_libdir \${prefix}/lib)
set(pc_includedir ${PROJECT_SOURCE_DIR}/include)
configure_file(cmake/lanthorn.pc.in lib/pkgconfig/lanthorn.pc @ONLY)
# Relative to the file itself, so that it holds for any --prefix.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig OUTPUT_VARIABLE pc_prefix)
string(PREPEND pc_prefix \${pcfiledir}/)
set(pc_libdir \${prefix}/${CMAKE_INSTALL_LIBDIR})
set(pc_includedir \${prefix}/${CMAKE_INSTALL_INCLUDEDIR})
configure_file(cmake/lanthorn.pc.in installed/lanthorn.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/installed/lanthorn.pc DESTINATION ${pkgconfig_dir} COMPONENT development)
