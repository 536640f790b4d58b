-- Configuration of the server for `vim.lsp.enable('rungwise')` (Neovim 0.11 and later).
local client = require('rungwise.client')
local config = client.config()

-- Markdown is served for the programs in its fences, and of all TOML the manifest; other texts have no need of the server.
config.filetypes = vim.list_extend({ 'markdown', 'toml' }, config.filetypes)
config.root_dir = function(buffer, on_dir)
  if client.serves(buffer) then
    on_dir(vim.fs.root(buffer, config.root_markers))
  end
end

return config
