if vim.g.loaded_rungwise then
  return
end
vim.g.loaded_rungwise = true

require('rungwise.commands').create()
require('rungwise.mappings').define()
require('rungwise.translations').register()

vim.api.nvim_create_autocmd('LspAttach', {
  group = vim.api.nvim_create_augroup('rungwise_attach', { clear = true }),
  callback = function(event)
    local client = vim.lsp.get_client_by_id(event.data.client_id)
    if client and client.name == 'rungwise' and vim.bo[event.buf].filetype == 'ladder' then
      require('rungwise.typing').attach(event.buf)
    end
  end,
})

-- nvim-dap is asked for when a program is opened, lest it be loaded for nothing.
vim.api.nvim_create_autocmd('FileType', {
  pattern = require('rungwise.client').filetypes,
  once = true,
  callback = function()
    require('rungwise.dap').setup()
  end,
})

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
