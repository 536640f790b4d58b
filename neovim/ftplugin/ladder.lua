if vim.b.did_ftplugin then
  return
end
vim.b.did_ftplugin = 1

local set = vim.opt_local
set.commentstring = '// %s'
set.comments = 's1:(*,ex:*),://'
set.iskeyword = '@,48-57,_,192-255,%,.,#'
-- A drawing is a grid: blocks may reach beyond the end of a line, and nothing may wrap, break or turn into tabs.
set.virtualedit = 'block'
set.wrap = false
set.expandtab = true
set.tabstop = 8
set.textwidth = 0
set.formatoptions:remove('t')
set.autoindent = false

vim.b.undo_ftplugin = 'setlocal commentstring< comments< iskeyword< virtualedit< wrap< expandtab< tabstop< textwidth<'
  .. ' formatoptions< autoindent<'
local unmap = require('rungwise.mappings').attach(0)
if unmap ~= '' then
  vim.b.undo_ftplugin = vim.b.undo_ftplugin .. ' | ' .. unmap
end
