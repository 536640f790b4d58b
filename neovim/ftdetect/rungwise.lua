-- Neovim knows `.il` as a Lisp of chip designers; with this plugin installed it is Instruction List.
vim.filetype.add({ extension = { lad = 'ladder', il = 'plc-il' } })
