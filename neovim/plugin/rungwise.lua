if vim.g.loaded_rungwise then
  return
end
vim.g.loaded_rungwise = true

require('rungwise.commands').create()

if type(vim.g.rungwise) ~= 'table' or vim.g.rungwise.enable ~= false then
  -- A missing server is only worth a message when a program is opened, so the message waits for one.
  local enabled, reason = require('rungwise.client').enable()
  if not enabled then
    vim.api.nvim_create_autocmd('FileType', {
      pattern = require('rungwise.client').filetypes,
      once = true,
      callback = function()
        vim.notify('Rungwise: ' .. reason, vim.log.levels.WARN)
      end,
    })
  end
end
