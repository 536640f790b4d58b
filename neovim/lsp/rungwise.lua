-- Configuration of the server for `vim.lsp.enable('rungwise')` (Neovim 0.11 and later).
return require('rungwise.client').config()
