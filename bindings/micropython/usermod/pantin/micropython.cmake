# For ports that are built with CMake (ESP32, RP2): `make USER_C_MODULES=FOLDER/pantin/micropython.cmake`.
add_library(usermod_pantin INTERFACE)
set(PANTIN_SOURCES
    mod_pantin.c mod_figure.c mod_face.c
    src/pantin.c src/pantin_keys.c src/pantin_turn.c src/pantin_figure.c src/pantin_solid.c src/pantin_face.c src/pantin_talk.c)
list(TRANSFORM PANTIN_SOURCES PREPEND ${CMAKE_CURRENT_LIST_DIR}/)
target_sources(usermod_pantin INTERFACE ${PANTIN_SOURCES})
target_include_directories(usermod_pantin INTERFACE ${CMAKE_CURRENT_LIST_DIR}/src)
target_compile_definitions(usermod_pantin INTERFACE PANTIN_KEYS=1)
target_link_libraries(usermod INTERFACE usermod_pantin)
