# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
# Installs a build into a folder of its own, builds examples/render_a_file against that alone and against the build
# folder alone, by find_package and by pkg-config, and renders with all of them.
#   cmake -DBUILD_DIR=... -DSOURCE_DIR=... -DLIBDIR=lib -DCOMPILER=... -DGENERATOR=... -P install_test.cmake
set(work ${BUILD_DIR}/install_test)
set(prefix ${work}/prefix)
set(example ${SOURCE_DIR}/examples/render_a_file)
file(REMOVE_RECURSE ${work})
file(MAKE_DIRECTORY ${work})

function(run)
  execute_process(COMMAND ${ARGV} WORKING_DIRECTORY ${work} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(result)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\n${output}\nfailed: ${result}")
  endif()
endfunction()

function(require_file file)
  if(NOT EXISTS ${file})
    message(SEND_ERROR "there is no ${file}")
  endif()
endfunction()

function(expect_render program picture)
  run(${program} ${SOURCE_DIR}/tests/scenes/emitters.pbrt ${picture})
  require_file(${work}/${picture})
endfunction()

function(check_files)
  foreach(file IN ITEMS bin/lanthorn include/lanthorn/session.h ${LIBDIR}/liblanthorn.so
                        ${LIBDIR}/lanthorn/lanthorn-openimageio.so ${LIBDIR}/pkgconfig/lanthorn.pc
                        ${LIBDIR}/cmake/lanthorn/lanthorn-config.cmake ${LIBDIR}/cmake/lanthorn/lanthorn-config-version.cmake
                        ${LIBDIR}/cmake/lanthorn/lanthorn-targets.cmake share/man/man1/lanthorn.1
                        share/man/man1/lanthorn-render.1 share/bash-completion/completions/lanthorn
                        share/doc/lanthorn/docs/using.md share/doc/lanthorn/docs/methods/vcm.md
                        share/doc/lanthorn/README.md share/doc/lanthorn/LICENSE share/doc/lanthorn/CHANGELOG.md
                        share/lanthorn/scenes/ring.pbrt share/lanthorn/scenes/ring.ply)
    require_file(${prefix}/${file})
  endforeach()
endfunction()

# What a user of the package is told must hold without the folders it was built in, and without its compiler flags.
function(check_usage)
  file(GLOB files ${prefix}/${LIBDIR}/cmake/lanthorn/*.cmake ${prefix}/${LIBDIR}/pkgconfig/*.pc)
  foreach(file IN LISTS files)
    file(READ ${file} text)
    # The package's own folders, which are not those that it was built in, even if the sources lie in /lanthorn.
    string(REGEX REPLACE "(}|${LIBDIR})/lanthorn" "" text "${text}")
    foreach(word IN ITEMS ${BUILD_DIR} ${SOURCE_DIR} -Wall -march lanthorn_flags)
      string(FIND "${text}" ${word} place)
      if(NOT place EQUAL -1)
        message(SEND_ERROR "${file} contains ${word}")
      endif()
    endforeach()
  endforeach()
endfunction()

# FOLDER is the prefix of an installation, or the build folder.
function(check_find_package folder)
  file(REMOVE_RECURSE ${work}/example)
  run(${CMAKE_COMMAND} -G "${GENERATOR}" -S ${example} -B ${work}/example -DCMAKE_PREFIX_PATH=${folder} -DCMAKE_CXX_COMPILER=${COMPILER})
  run(${CMAKE_COMMAND} --build ${work}/example)
  file(REMOVE ${work}/cmake.exr)
  expect_render(${work}/example/render_a_file cmake.exr)
endfunction()

# FOLDER/LIB is the folder of the library.
function(check_pkg_config folder lib)
  find_program(pkg_config pkg-config)
  if(NOT pkg_config)
    message("*** SKIPPED: there is no pkg-config; ${folder}/${lib}/pkgconfig/lanthorn.pc IS NOT TESTED ***")
    return()
  endif()
  set(ENV{PKG_CONFIG_PATH} ${folder}/${lib}/pkgconfig)
  execute_process(COMMAND ${pkg_config} --cflags --libs lanthorn OUTPUT_VARIABLE flags
                  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  # An update of a library by a patch must not break programs that are built after it.
  if(flags MATCHES "[.]so[.0-9]+")
    message(SEND_ERROR "lanthorn.pc names a version of a library: ${flags}")
  endif()
  separate_arguments(flags UNIX_COMMAND "${flags}")
  run(${COMPILER} -std=c++20 ${example}/main.cpp -o ${work}/by_pkg_config ${flags} -Wl,-rpath,${folder}/${lib})
  file(REMOVE ${work}/pkg-config.png)
  expect_render(${work}/by_pkg_config pkg-config.png)
endfunction()

# The module finds what it loads: images need lanthorn-openimageio.so.
function(check_python)
  if(NOT PYTHON)
    return()
  endif()
  execute_process(COMMAND ${PYTHON} -c "import numpy" RESULT_VARIABLE without_numpy OUTPUT_QUIET ERROR_QUIET)
  if(without_numpy)
    message("*** SKIPPED: ${PYTHON} has no numpy; THE PYTHON MODULE IS NOT TESTED ***")
    return()
  endif()
  file(WRITE ${work}/render.py "import lanthorn
assert lanthorn.__file__.startswith('${prefix}'), lanthorn.__file__
scene = lanthorn.load_file('${SOURCE_DIR}/tests/scenes/lamps-with-images.pbrt')
lanthorn.render(scene, passes=1, resolution=(16, 16)).save('python.png')
")
  run(${CMAKE_COMMAND} -E env PYTHONPATH=${prefix}/${PYTHON_DIR} ${PYTHON} render.py)
  require_file(${work}/python.png)
endfunction()

# scripts/build builds the target installed_files alone, not all targets as the build of the tests does: each file that is
# built and installed must belong to it.
function(check_built_files)
  find_program(ninja ninja)
  if(NOT GENERATOR STREQUAL Ninja OR NOT ninja)
    message("*** SKIPPED: the generator is not Ninja; THE TARGET installed_files IS NOT TESTED ***")
    return()
  endif()
  execute_process(COMMAND ${ninja} -C ${BUILD_DIR} -t targets all OUTPUT_VARIABLE built COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${ninja} -C ${BUILD_DIR} -t graph installed_files OUTPUT_VARIABLE graph COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB scripts ${BUILD_DIR}/cmake_install.cmake ${BUILD_DIR}/*/cmake_install.cmake ${BUILD_DIR}/*/*/cmake_install.cmake)
  set(count 0)
  foreach(script IN LISTS scripts)
    file(READ ${script} text)
    string(REGEX MATCHALL "\"${BUILD_DIR}/[^\"]+\"" files "${text}")
    foreach(file IN LISTS files)
      string(REGEX REPLACE "^\"${BUILD_DIR}/|\"$" "" file ${file})
      if("\n${built}" MATCHES "\n${file}: ")
        math(EXPR count "${count} + 1")
        string(REGEX REPLACE "[.]so[.0-9]+$" ".so" file ${file})  # the links to a library are made with it
        string(FIND "${graph}" "label=\"${file}\"" place)
        if(place EQUAL -1)
          message(SEND_ERROR "the target installed_files does not build ${file}")
        endif()
      endif()
    endforeach()
  endforeach()
  if(count LESS 3)
    message(SEND_ERROR "found only ${count} files that are built and installed")
  endif()
endfunction()

check_built_files()
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
check_files()
check_usage()
check_find_package(${prefix})
check_find_package(${BUILD_DIR})
check_pkg_config(${prefix} ${LIBDIR})
check_pkg_config(${BUILD_DIR} lib)
check_python()
# The folder can be moved: nothing in it knows where it is.
file(RENAME ${prefix} ${work}/moved)
run(${work}/moved/bin/lanthorn render ${work}/moved/share/lanthorn/scenes/ring.pbrt -r 16x16 -p 1 -o moved.exr)
run(${work}/moved/bin/lanthorn info moved.exr)
file(REMOVE_RECURSE ${work})
