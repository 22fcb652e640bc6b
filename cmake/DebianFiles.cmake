# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
# cpack runs this on the files of each package: adds what Debian asks for, and compresses what it wants compressed.
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

if(DEFINED ENV{SOURCE_DATE_EPOCH})
  set(time @$ENV{SOURCE_DATE_EPOCH})
else()
  set(time now)
endif()
execute_process(COMMAND date --utc --rfc-email --date=${time} OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE)

foreach(group IN ITEMS program mpi development doc python)
  string(TOUPPER ${group} key)
  set(root ${CPACK_TEMPORARY_DIRECTORY}/${group}/usr/share)
  if(NOT EXISTS ${CPACK_TEMPORARY_DIRECTORY}/${group})
    continue()
  endif()
  set(doc ${root}/doc/${CPACK_DEBIAN_${key}_PACKAGE_NAME})
  file(MAKE_DIRECTORY ${doc})
  file(WRITE ${doc}/copyright
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/

Files: *
Copyright: 2026 The Lanthorn authors
License: Apache-2.0
 On Debian systems, the text of the Apache License, version 2.0, is in
 /usr/share/common-licenses/Apache-2.0.
")
  file(REMOVE ${doc}/LICENSE)
  file(WRITE ${doc}/changelog
"lanthorn (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * Release. CHANGELOG.md in the package lanthorn has the changes.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
  run(gzip --best --no-name ${doc}/changelog)
  file(GLOB pages ${root}/man/*/*.[0-9])
  if(pages)
    run(gzip --best --no-name --force ${pages})
  endif()
endforeach()
