# cmake -D NAME=gram -D SOURCE=gram.cl -D OUTPUT=gram.cl.cpp -P embed.cmake
# Writes a .cpp that holds the kernel file as one string; #line keeps file and line in compiler logs.
file(READ ${SOURCE} text)
get_filename_component(file ${SOURCE} NAME)
file(WRITE ${OUTPUT} "#include \"moclean/device/kernel_source.hpp\"

const std::string_view moclean::kernel_source::${NAME} =
    R\"kernel(#line 1 \"${file}\"
${text})kernel\";
")
