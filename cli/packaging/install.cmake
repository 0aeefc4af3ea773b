# What `cmake --install` brings, and the Debian package that `cpack -G DEB` makes of it. The manual page, completions and
# schemas are what the program itself prints.
include(GNUInstallDirs)
install(TARGETS relook)
install(TARGETS relook_images relook_meshes relook_views relook_text LIBRARY DESTINATION lib/relook)

set(PRINTED "${CMAKE_CURRENT_BINARY_DIR}/printed")
set(PRINTED_FILES)
# printed(FILE ARGUMENTS...): FILE holds what `relook ARGUMENTS` prints. It is made with everything, and for installation.
function(printed FILE)
  add_custom_command(OUTPUT "${PRINTED}/${FILE}"
    COMMAND ${CMAKE_COMMAND} -E make_directory "${PRINTED}"
    COMMAND relook ${ARGN} > "${PRINTED}/${FILE}"
    DEPENDS relook VERBATIM)
  list(APPEND PRINTED_FILES "${PRINTED}/${FILE}")
  set(PRINTED_FILES "${PRINTED_FILES}" PARENT_SCOPE)
endfunction()
printed(relook.1 --help-man)
printed(relook.bash completions bash)
printed(_relook completions zsh)
printed(relook.fish completions fish)
if(EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/cli/schema.cpp")
  printed(journal.schema.json schema journal)
  install(FILES "${PRINTED}/journal.schema.json" DESTINATION ${CMAKE_INSTALL_DATADIR}/relook/schemas)
endif()
find_program(GZIP gzip)
if(GZIP)  # as Debian wants manual pages
  add_custom_command(OUTPUT "${PRINTED}/relook.1.gz" COMMAND "${GZIP}" -9nkf "${PRINTED}/relook.1"
    DEPENDS "${PRINTED}/relook.1" VERBATIM)
  list(APPEND PRINTED_FILES "${PRINTED}/relook.1.gz")
  install(FILES "${PRINTED}/relook.1.gz" DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
else()
  install(FILES "${PRINTED}/relook.1" DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
endif()
add_custom_target(relook_printed ALL DEPENDS ${PRINTED_FILES})

install(FILES "${PRINTED}/relook.bash" DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME relook)
install(FILES "${PRINTED}/_relook" DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES "${PRINTED}/relook.fish" DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(FILES src/report/report.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/relook/schemas)
install(FILES cli/python/relook.py DESTINATION ${CMAKE_INSTALL_DATADIR}/relook/python)
install(CODE "if(CMAKE_INSTALL_PREFIX STREQUAL \"/usr\")  # where Debian's Python finds it
  file(INSTALL \"${CMAKE_CURRENT_SOURCE_DIR}/cli/python/relook.py\"
    DESTINATION \"\$ENV{DESTDIR}/usr/lib/python3/dist-packages\")
endif()")
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
# What is built in: the font of labels, the plots of pages.
install(FILES /usr/share/doc/fonts-dejavu-core/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright.dejavu OPTIONAL)
install(FILES /usr/share/doc/libjs-chart.js/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright.chart.js OPTIONAL)
set(EXAMPLES ${CMAKE_INSTALL_DATADIR}/relook/examples)
install(DIRECTORY journals DESTINATION ${EXAMPLES})
install(DIRECTORY scenes/spheres scenes/recipes scenes/blender DESTINATION ${EXAMPLES}/scenes
  PATTERN __pycache__ EXCLUDE)
install(FILES scenes/from_blender.py DESTINATION ${EXAMPLES}/scenes)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME relook)
set(CPACK_PACKAGE_VENDOR "relook")
set(CPACK_PACKAGE_CONTACT "The relook authors <relook@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "replay edits of a scene, recompute exactly the part that changed")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS python3)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "blender, python3-openimageio")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "replay edits of a scene, recompute exactly the part that changed
 relook renders a glTF 2.0 scene once, for one fixed camera, and keeps the path
 of every ray on disk. Then it replays journals, lists of edits to materials,
 textures, lights and objects, as EXR frames that are bit for bit those of full
 renders, and reports what each step cost and what it could skip.")
include(CPack)
