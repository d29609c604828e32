# Plain comments as those that Doxygen takes: at the head of a file, before a declaration, after one. What is set
# apart in a comment stays so, and < is no tag.
1s|^/\* (sphode/[a-z_]+\.h) -- |/** @file \1\n * |
s|^( *)/\* |\1/** |
s|([;,{]) */\* |\1 /**< |
/^ *\*   /{
  s|^( *)\*|\1*     |
  b
}
/^ *\/?\*/{
  s|([^*])<|\1\\<|g
}
/\/\*\*< /s|([^*])<|\1\\<|g
