# cmake -DINPUT=contract.descriptors -DOUTPUT=embedded_contract.cpp -P embed_contract.cmake
file(READ ${INPUT} bytes HEX)
string(LENGTH "${bytes}" length)
math(EXPR count "${length} / 2")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"server/contract/embedded_contract.h\"

namespace tribodyn::server {

std::string_view embedded_contract() {
  static constexpr char kBytes[] =
      \"${bytes}\";
  return {kBytes, ${count}};
}

}  // namespace tribodyn::server
")
