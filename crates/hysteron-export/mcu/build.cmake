# The C of `@name@` as a target of CMake, for the processor that the project is for:
#     include(mcu/@name@.cmake)
#     target_link_libraries(app PRIVATE hysteron_@name@)
add_library(hysteron_@name@ STATIC
@sources@)
target_include_directories(hysteron_@name@ PUBLIC "${CMAKE_CURRENT_LIST_DIR}")
set_target_properties(hysteron_@name@ PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON)
# Without fused products the digits are those of the library.
if(NOT MSVC)
    target_compile_options(hysteron_@name@ PRIVATE -ffp-contract=off)
endif()
